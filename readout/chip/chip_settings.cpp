#include "readout/chip/chip_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "core/error.h"
#include "readout/chip/register_map.h"
#include "readout/chip_registers.h"
#include "readout/program/sequencer_program.h"
#include "readout/timing/slot_readout.h"

namespace stipple {
namespace {

constexpr std::uint32_t kPlaces = 16;  ///< of a register array

/// Products of LINK_BITS and columns stay below 2^63.
constexpr std::int64_t kMaxLink = std::int64_t{1} << 44U;

/// \throws InputError naming the register.
void require(bool holds, std::uint32_t address, const std::string& limit) {
    if (!holds) throw InputError(register_name(address), limit);
}

class Writer {
  public:
    void set(std::uint32_t address, std::int64_t value) {
        const auto bits = static_cast<unsigned>(register_at(address)->bits);
        require(value >= 0 && value < std::int64_t{1} << bits, address,
                fmt::format("{} has more than {} bits", value, bits));
        values[address] = static_cast<std::uint32_t>(value);
    }
    void set_wide(std::uint32_t address, std::int64_t value) {
        set(address, value & 0xFFFFFFFF);
        set(address + 4, value >> 32U);
    }
    /// Unused places equal the last value.
    void set_list(std::uint32_t address, const std::vector<int>& list) {
        require(list.size() <= kPlaces, address,
                fmt::format("{} values are more than {}", list.size(), kPlaces));
        for (std::uint32_t i = 0; i < kPlaces; ++i)
            set(address + 4 * i,
                list.empty() ? 0 : list[std::min<std::size_t>(i, list.size() - 1)]);
    }

    RegisterValues values;
};

class Reader {
  public:
    explicit Reader(const RegisterValues& values) : values_(values) {}

    [[nodiscard]] std::uint32_t raw(std::uint32_t address) const {
        const auto found = values_.find(address);
        return found == values_.end() ? 0 : found->second;
    }
    /// \throws InputError unless it is within the limits.
    [[nodiscard]] int number(std::uint32_t address, std::int64_t least = 0,
                             std::int64_t most = std::numeric_limits<int>::max()) const {
        const std::int64_t value = raw(address);
        require(value >= least && value <= most, address,
                fmt::format("{} is not {} to {}", value, least, most));
        return static_cast<int>(value);
    }
    [[nodiscard]] std::int64_t wide(std::uint32_t address) const {
        const std::uint64_t value = raw(address) | std::uint64_t{raw(address + 4)} << 32U;
        require(value <= static_cast<std::uint64_t>(kMaxLink), address,
                fmt::format("{} is more than {}", value, kMaxLink));
        return static_cast<std::int64_t>(value);
    }
    /// Without the repetitions of the last value.
    [[nodiscard]] std::vector<int> list(std::uint32_t address) const {
        std::vector<int> list;
        for (std::uint32_t i = 0; i < kPlaces; ++i) list.push_back(number(address + 4 * i));
        while (list.size() > 1 && list.back() == list[list.size() - 2]) list.pop_back();
        return list;
    }

  private:
    const RegisterValues& values_;
};

void read_link(const Reader& registers, ReadoutTiming& timing) {
    const std::int64_t bits = registers.wide(STIPPLE_LINK_BITS_LOW);
    if (bits == 0) return;
    const std::int64_t rate = registers.wide(STIPPLE_LINK_RATE_LOW);
    require(rate > 0, STIPPLE_LINK_RATE_LOW, "is 0, but LINK_BITS is not");
    // transfer_clocks: columns x channels x 1 bit x clock_hz, by the bits per second of the lanes.
    timing.bits_per_sample = 1;
    timing.clock_hz = bits;
    timing.link_lanes = 1;
    timing.link_bps = rate * timing.addressing.channels;
}

void read_row_timing(const Reader& registers, ReadoutTiming& timing) {
    timing.row_timing = static_cast<RowTiming>(registers.number(STIPPLE_ROW_TIMING, 0, 2));
    timing.exposes_while_reading = registers.raw(STIPPLE_EXPOSES_WHILE_READING) != 0;
    timing.rot_clocks = registers.number(STIPPLE_ROT_CLOCKS);
    timing.skip_row_clocks = registers.number(STIPPLE_SKIP_ROW_CLOCKS);
    timing.settle_margin = static_cast<std::int32_t>(registers.raw(STIPPLE_SETTLE_MARGIN));
    timing.settle_clocks = registers.list(STIPPLE_SETTLE_CLOCKS);
    timing.adc_clocks = registers.number(STIPPLE_ADC_CLOCKS);
    timing.adc_skip = registers.raw(STIPPLE_ADC_SKIP) != 0;
    timing.blanking_clocks = registers.number(STIPPLE_BLANKING_CLOCKS);
    timing.clocks_per_column = registers.number(STIPPLE_CLOCKS_PER_COLUMN, 1);
    timing.io_clocks = registers.number(STIPPLE_IO_CLOCKS);
    if (registers.raw(STIPPLE_HAS_TABLE) != 0) {
        timing.row_table_cols = registers.list(STIPPLE_TABLE_COLS);
        timing.row_table_clocks = registers.list(STIPPLE_TABLE_CLOCKS);
        timing.row_table_clocks.resize(timing.row_table_cols.size(),
                                       timing.row_table_clocks.back());
    }
    timing.overhead_clocks = registers.raw(STIPPLE_OVERHEAD_CLOCKS);
    timing.overhead_rows = registers.number(STIPPLE_OVERHEAD_ROWS);
    read_link(registers, timing);
}

}  // namespace

ChipGeometry geometry_of(const SensorSetup& setup) {
    if (!setup.timing) throw InputError("sensor " + setup.params.name, no_timing_text());
    const ReadoutTiming& timing = *setup.timing;
    const SequencerProgram program = compile_schedule(setup.schedule.schedule);
    return {.rows = timing.rows,
            .cols = timing.cols,
            .addressing = timing.addressing,
            .columns_per_adc = timing.columns_per_adc,
            .tile_rows = program.tile_rows,
            .tile_cols = program.tile_cols,
            .pixel_bits = program.bits_per_pixel,
            .depth = std::max(program.period_slots, 16),
            .bit_depth = setup.params.bit_depth,
            .dark_rows_max = std::max(timing.dark_rows, 2)};
}

void check_geometry(const ChipGeometry& geometry) {
    const auto check = [](int value, int most, const char* what) {
        if (value < 1 || value > most)
            throw InputError("chip", fmt::format("{} = {} is not 1 to {}", what, value, most));
    };
    check(geometry.tile_rows, kMaxTileSide, "TILE_ROWS");
    check(geometry.tile_cols, kMaxTileSide, "TILE_COLS");
    check(geometry.depth, kMaxPeriodSlots, "DEPTH");
    check(geometry.pixel_bits, 3, "PIXEL_BITS");
    // As a program file (docs/sequencer_program.md).
    constexpr std::int64_t kMostPixels = std::int64_t{1} << 28U;
    if (std::int64_t{geometry.tile_rows} * geometry.tile_cols > kMostPixels / geometry.depth)
        throw InputError("chip",
                         fmt::format("a memory of {} slots x {} x {} pixels has more than "
                                     "2^28; lower its depth or its tile",
                                     geometry.depth, geometry.tile_rows, geometry.tile_cols));
}

RegisterValues register_values(const ReadoutTiming& timing, FrameShape window, SlotBudget budget) {
    Writer to;
    to.set(STIPPLE_ROWS, window.rows);
    to.set(STIPPLE_COLS, window.cols);
    to.set(STIPPLE_DROPS, budget.policy == OverrunPolicy::kDrop ? 1 : 0);
    to.set(STIPPLE_SLOT_CLOCKS,
           std::max({budget.clocks, std::int64_t{1}, code_load_clocks(timing, window.rows)}));
    to.set(STIPPLE_BUDGET_CLOCKS, budget.clocks);
    to.set(STIPPLE_ROW_TIMING, static_cast<int>(timing.row_timing));
    to.set(STIPPLE_EXPOSES_WHILE_READING, timing.exposes_while_reading ? 1 : 0);
    to.set(STIPPLE_ROT_CLOCKS, timing.rot_clocks);
    to.set(STIPPLE_SKIP_ROW_CLOCKS, timing.skip_row_clocks);
    to.set(STIPPLE_SETTLE_MARGIN, static_cast<std::uint32_t>(timing.settle_margin));
    to.set(STIPPLE_ADC_CLOCKS, timing.adc_clocks);
    to.set(STIPPLE_ADC_SKIP, timing.adc_skip ? 1 : 0);
    to.set(STIPPLE_BLANKING_CLOCKS, timing.blanking_clocks);
    to.set(STIPPLE_CLOCKS_PER_COLUMN, timing.clocks_per_column);
    to.set(STIPPLE_IO_CLOCKS, timing.io_clocks);
    to.set(STIPPLE_HAS_TABLE, timing.row_table_cols.empty() ? 0 : 1);
    to.set(STIPPLE_DARK_ROWS, timing.dark_rows);
    to.set(STIPPLE_OVERHEAD_CLOCKS, timing.overhead_clocks);
    to.set(STIPPLE_OVERHEAD_ROWS, timing.overhead_rows);
    to.set(STIPPLE_FULL_ROW_CLOCKS, full_row_clocks(timing, window.cols));
    const bool has_link = timing.link_lanes > 0;
    to.set_wide(
        STIPPLE_LINK_BITS_LOW,
        has_link ? timing.addressing.channels * timing.bits_per_sample * timing.clock_hz : 0);
    to.set_wide(STIPPLE_LINK_RATE_LOW, has_link ? timing.link_lanes * timing.link_bps : 0);
    to.set_list(STIPPLE_SETTLE_CLOCKS, timing.settle_clocks);
    to.set_list(STIPPLE_TABLE_COLS, timing.row_table_cols);
    to.set_list(STIPPLE_TABLE_CLOCKS, timing.row_table_clocks);
    return std::move(to.values);
}

RegisterValues capture_registers(const ChipCapture& capture, int bank) {
    const auto place = static_cast<std::uint32_t>(4 * bank);
    Writer to{register_values(capture.timing, capture.window, capture.budget)};
    to.set(STIPPLE_BANK_PERIOD + place, capture.period_slots);
    to.set(STIPPLE_BANK_OFFSET + place, capture.offset_slots);
    to.set(STIPPLE_SLOTS, capture.slots);
    return std::move(to.values);
}

CaptureSettings capture_settings(const RegisterValues& values, const ChipGeometry& geometry) {
    const Reader registers(values);
    CaptureSettings settings;
    ReadoutTiming& timing = settings.timing;
    timing.clock_hz = 1;
    timing.rows = geometry.rows;
    timing.cols = geometry.cols;
    timing.addressing = geometry.addressing;
    timing.columns_per_adc = geometry.columns_per_adc;
    timing.dark_rows = registers.number(STIPPLE_DARK_ROWS, 0, geometry.dark_rows_max);
    settings.window = {.rows = registers.number(STIPPLE_ROWS, 1, geometry.rows),
                       .cols = registers.number(STIPPLE_COLS, 1, geometry.cols)};
    settings.slot = {.clocks = registers.raw(STIPPLE_SLOT_CLOCKS),
                     .policy = registers.raw(STIPPLE_DROPS) != 0 ? OverrunPolicy::kDrop
                                                                 : OverrunPolicy::kStretch};
    require(settings.slot.clocks > 0, STIPPLE_SLOT_CLOCKS, "is 0");
    settings.budget_clocks = registers.raw(STIPPLE_BUDGET_CLOCKS);
    settings.slots = registers.raw(STIPPLE_SLOTS);
    read_row_timing(registers, timing);
    validate(timing, "registers");
    const std::int64_t full_row = full_row_clocks(timing, settings.window.cols);
    if (timing.overhead_rows > 0)
        require(registers.raw(STIPPLE_FULL_ROW_CLOCKS) == full_row, STIPPLE_FULL_ROW_CLOCKS,
                fmt::format("the row time of all columns is {} clocks", full_row));
    return settings;
}

}  // namespace stipple
