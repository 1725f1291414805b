#include "tests/rtl/chip_capture.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "core/index.h"
#include "readout/chip_registers.h"

namespace stipple {
namespace {

std::uint32_t word(std::int64_t value) {
    return static_cast<std::uint32_t>(value);
}

/// Value `place` of a register array, whose unused ones equal the last.
template <typename Values>
std::uint32_t padded(const Values& values, std::size_t place) {
    return values.empty() ? 0 : word(values[std::min(place, values.size() - 1)]);
}

void set_wide(ChipSimulation& chip, std::uint32_t address, std::int64_t value) {
    set(chip, address, word(value));
    set(chip, address + 4, word(value >> 32));
}

void set_timing(ChipSimulation& chip, const ReadoutTiming& timing) {
    set(chip, STIPPLE_ROW_TIMING,
        timing.row_timing == RowTiming::kSequential  ? 1
        : timing.row_timing == RowTiming::kFullWidth ? 2
                                                     : 0);
    set(chip, STIPPLE_EXPOSES_WHILE_READING, timing.exposes_while_reading ? 1 : 0);
    set(chip, STIPPLE_ROT_CLOCKS, word(timing.rot_clocks));
    set(chip, STIPPLE_SKIP_ROW_CLOCKS, word(timing.skip_row_clocks));
    set(chip, STIPPLE_SETTLE_MARGIN, word(timing.settle_margin));
    set(chip, STIPPLE_ADC_CLOCKS, word(timing.adc_clocks));
    set(chip, STIPPLE_ADC_SKIP, timing.adc_skip ? 1 : 0);
    set(chip, STIPPLE_BLANKING_CLOCKS, word(timing.blanking_clocks));
    set(chip, STIPPLE_CLOCKS_PER_COLUMN, word(timing.clocks_per_column));
    set(chip, STIPPLE_IO_CLOCKS, word(timing.io_clocks));
    set(chip, STIPPLE_HAS_TABLE, timing.row_table_cols.empty() ? 0 : 1);
    set(chip, STIPPLE_DARK_ROWS, word(timing.dark_rows));
    set(chip, STIPPLE_OVERHEAD_CLOCKS, word(timing.overhead_clocks));
    set(chip, STIPPLE_OVERHEAD_ROWS, word(timing.overhead_rows));
    const bool has_link = timing.link_lanes > 0;
    set_wide(chip, STIPPLE_LINK_BITS_LOW,
             has_link ? static_cast<std::int64_t>(timing.addressing.channels *
                                                  timing.bits_per_sample * timing.clock_hz)
                      : 0);
    set_wide(chip, STIPPLE_LINK_RATE_LOW,
             has_link ? static_cast<std::int64_t>(timing.link_lanes * timing.link_bps) : 0);
    for (std::uint32_t i = 0; i < 16; ++i) {
        set(chip, STIPPLE_SETTLE_CLOCKS + 4 * i, padded(timing.settle_clocks, i));
        set(chip, STIPPLE_TABLE_COLS + 4 * i, padded(timing.row_table_cols, i));
        set(chip, STIPPLE_TABLE_CLOCKS + 4 * i, padded(timing.row_table_clocks, i));
    }
}

}  // namespace

std::int64_t fill_clocks(const ChipSize& size, int rows, int period_slots) {
    return std::int64_t{3 * size.tile_rows + 2 * rows} * period_slots;
}

void set(ChipSimulation& chip, std::uint32_t address, std::uint32_t value) {
    if (!chip.write(address, value))
        throw InputError(fmt::format("register 0x{:03X}", address),
                         fmt::format("does not take {}", value));
}

std::uint32_t get(ChipSimulation& chip, std::uint32_t address) {
    const auto value = chip.read(address);
    if (!value) throw InputError(fmt::format("register 0x{:03X}", address), "is not there");
    return *value;
}

void set_up(ChipSimulation& chip, const ChipCapture& capture) {
    const std::uint32_t bank = (get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_BANK) != 0 ? 1 : 0;
    set(chip, STIPPLE_BANK_PERIOD + 4 * bank, word(capture.period_slots));
    set(chip, STIPPLE_BANK_OFFSET + 4 * bank, word(capture.offset_slots));
    set(chip, STIPPLE_SLOTS, word(capture.slots));
    set(chip, STIPPLE_ROWS, word(capture.window.rows));
    set(chip, STIPPLE_COLS, word(capture.window.cols));
    set(chip, STIPPLE_DROPS, capture.budget.policy == OverrunPolicy::kDrop ? 1 : 0);
    set(chip, STIPPLE_SLOT_CLOCKS,
        word(std::max({capture.budget.clocks, std::int64_t{1},
                       code_load_clocks(capture.timing, capture.window.rows)})));
    set(chip, STIPPLE_BUDGET_CLOCKS, word(capture.budget.clocks));
    set(chip, STIPPLE_FULL_ROW_CLOCKS, word(full_row_clocks(capture.timing, capture.window.cols)));
    set_timing(chip, capture.timing);
}

void load_bank(ChipSimulation& chip, const SequencerProgram& program, int bank) {
    set(chip, STIPPLE_MEMORY_ADDRESS, word(bank) << 31U);
    const auto bits = static_cast<std::size_t>(program.bits_per_pixel);
    const std::size_t row_pixels = index(program.tile_cols);
    for (std::size_t first = 0; first < program.pixels.size(); first += row_pixels) {
        std::vector<std::uint32_t> parts((row_pixels * bits + 31) / 32);
        for (std::size_t bit = 0; bit < row_pixels * bits; ++bit)
            parts[bit / 32] |= (program.pixels[first + bit / bits] >> (bit % bits) & 1U)
                               << (bit % 32);
        for (const std::uint32_t part : parts) set(chip, STIPPLE_MEMORY_DATA, part);
    }
    set(chip, STIPPLE_BANK_PERIOD + 4 * word(bank), word(program.period_slots));
}

void wait_for_end(ChipSimulation& chip, std::int64_t max_clocks) {
    const std::int64_t last = chip.clocks + max_clocks;
    while ((get(chip, STIPPLE_STATUS) & STIPPLE_STATUS_RUNNING) != 0) {
        if (chip.clocks > last) throw InputError("chip", "does not end its capture");
        chip.wait(20);
    }
}

}  // namespace stipple
