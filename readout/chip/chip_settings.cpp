#include "readout/chip/chip_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "readout/chip_registers.h"
#include "readout/timing/slot_readout.h"

namespace stipple {
namespace {

struct Register {
    std::string_view name;
    std::uint32_t address;
    std::uint32_t count;
    unsigned bits;
};

#define STIPPLE_REGISTER(name, address, count, bits, reset, access, lock) \
    Register{#name, address, count, bits},
constexpr auto kRegisters = std::to_array<Register>({STIPPLE_REGISTERS(STIPPLE_REGISTER)});
#undef STIPPLE_REGISTER

const Register* register_at(std::uint32_t address) {
    const auto* const found = std::ranges::find_if(kRegisters, [&](const Register& it) {
        return address >= it.address && address < it.address + 4 * it.count && address % 4 == 0;
    });
    return found == kRegisters.end() ? nullptr : found;
}

/// Values in the order in which they are written.
class Settings {
  public:
    void set(std::uint32_t address, std::int64_t value) {
        const unsigned bits = register_at(address)->bits;
        const bool is_signed = address == STIPPLE_SETTLE_MARGIN;
        if ((value < 0 && !is_signed) || value >= std::int64_t{1} << bits)
            throw InputError("chip",
                             fmt::format("the register {} has {} bits, which do not hold {}",
                                         register_name(address), bits, value));
        values_.push_back({address, static_cast<std::uint32_t>(value)});
    }
    /// Lower half first.
    void set_wide(std::uint32_t address, std::int64_t value) {
        set(address, value & 0xFFFF'FFFF);
        set(address + 4, value >> 32);
    }
    /// A register array, whose unused ones equal the last.
    void set_list(std::uint32_t address, const std::vector<int>& values) {
        const std::size_t count = register_at(address)->count;
        if (values.size() > count)
            throw InputError("chip", fmt::format("{} values do not fit the {} registers {}",
                                                 values.size(), count, register_at(address)->name));
        for (std::size_t i = 0; i < count; ++i)
            set(address + 4 * static_cast<std::uint32_t>(i),
                values.empty() ? 0 : values[std::min(i, values.size() - 1)]);
    }
    std::vector<RegisterValue> take() { return std::move(values_); }

  private:
    std::vector<RegisterValue> values_;
};

int law_of(RowTiming timing) {
    switch (timing) {
        case RowTiming::kOverlapped:
            return 0;
        case RowTiming::kSequential:
            return 1;
        case RowTiming::kFullWidth:
            return 2;
    }
    return 0;
}

void set_timing(Settings& settings, const ReadoutTiming& timing) {
    settings.set(STIPPLE_ROW_TIMING, law_of(timing.row_timing));
    settings.set(STIPPLE_EXPOSES_WHILE_READING, timing.exposes_while_reading ? 1 : 0);
    settings.set(STIPPLE_ROT_CLOCKS, timing.rot_clocks);
    settings.set(STIPPLE_SKIP_ROW_CLOCKS, timing.skip_row_clocks);
    settings.set(STIPPLE_SETTLE_MARGIN, timing.settle_margin);
    settings.set(STIPPLE_ADC_CLOCKS, timing.adc_clocks);
    settings.set(STIPPLE_ADC_SKIP, timing.adc_skip ? 1 : 0);
    settings.set(STIPPLE_BLANKING_CLOCKS, timing.blanking_clocks);
    settings.set(STIPPLE_CLOCKS_PER_COLUMN, timing.clocks_per_column);
    settings.set(STIPPLE_IO_CLOCKS, timing.io_clocks);
    settings.set(STIPPLE_HAS_TABLE, timing.row_table_cols.empty() ? 0 : 1);
    settings.set(STIPPLE_DARK_ROWS, timing.dark_rows);
    settings.set(STIPPLE_OVERHEAD_CLOCKS, timing.overhead_clocks);
    settings.set(STIPPLE_OVERHEAD_ROWS, timing.overhead_rows);
    const bool has_link = timing.link_lanes > 0;
    settings.set_wide(
        STIPPLE_LINK_BITS_LOW,
        has_link ? timing.addressing.channels * timing.bits_per_sample * timing.clock_hz : 0);
    settings.set_wide(STIPPLE_LINK_RATE_LOW, has_link ? timing.link_lanes * timing.link_bps : 0);
    settings.set_list(STIPPLE_SETTLE_CLOCKS, timing.settle_clocks);
    settings.set_list(STIPPLE_TABLE_COLS, timing.row_table_cols);
    settings.set_list(STIPPLE_TABLE_CLOCKS, timing.row_table_clocks);
}

}  // namespace

std::vector<RegisterValue> chip_settings(const ChipCapture& capture, int bank) {
    const auto place = static_cast<std::uint32_t>(4 * bank);
    Settings settings;
    settings.set(STIPPLE_BANK_PERIOD + place, capture.period_slots);
    settings.set(STIPPLE_BANK_OFFSET + place, capture.offset_slots);
    settings.set(STIPPLE_SLOTS, capture.slots);
    settings.set(STIPPLE_ROWS, capture.window.rows);
    settings.set(STIPPLE_COLS, capture.window.cols);
    settings.set(STIPPLE_DROPS, capture.budget.policy == OverrunPolicy::kDrop ? 1 : 0);
    settings.set(STIPPLE_SLOT_CLOCKS,
                 std::max({capture.budget.clocks, std::int64_t{1},
                           code_load_clocks(capture.timing, capture.window.rows)}));
    settings.set(STIPPLE_BUDGET_CLOCKS, capture.budget.clocks);
    settings.set(STIPPLE_FULL_ROW_CLOCKS, full_row_clocks(capture.timing, capture.window.cols));
    set_timing(settings, capture.timing);
    return settings.take();
}

std::string register_name(std::uint32_t address) {
    const Register* const found = register_at(address);
    if (found == nullptr) return {};
    if (found->count == 1) return std::string(found->name);
    return fmt::format("{}[{}]", found->name, (address - found->address) / 4);
}

}  // namespace stipple
