#include "readout/chip/chip_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "core/error.h"
#include "readout/schedule_feasibility.h"
#include "readout/timing/row_loads.h"

namespace stipple {
namespace {

constexpr int kMaxWordBytes = 32;
constexpr int kMaxDepth = 65535;  // of the register DEPTH
constexpr std::int64_t kMaxWords = std::int64_t{1} << 24;

[[noreturn]] void refuse(const std::string& problem) {
    throw InputError("chip in gates", problem);
}

void check_divides(const char* parameter, int divisor, int cols) {
    if (cols % divisor != 0)
        refuse(fmt::format("{} = {} does not divide its {} columns; choose a width that it divides",
                           parameter, divisor, cols));
}

void check_sensor(const SensorSetup& setup) {
    const ReadoutTiming& timing = *setup.timing;
    if (setup.shape.planes > 1)
        refuse(fmt::format("it has one plane, not {} stacked ones", setup.shape.planes));
    if (setup.schedule.schedule.weighted())
        refuse("its pixels are open or closed; the schedule has weights");
    if (const auto problem = store_problem(setup.schedule.schedule, setup.params.charge_stores))
        refuse(*problem);
    check_divides("CHANNELS", timing.addressing.channels, timing.cols);
    check_divides("COLUMNS_PER_ADC", timing.columns_per_adc, timing.cols);
    const bool settles = !timing.settle_clocks.empty() && timing.settle_clocks.front() > 0;
    if (timing.rot_clocks == 0 && timing.adc_clocks == 0 && !settles)
        refuse(
            "a row needs a clock from its selection to its conversion; rot_clocks, adc_clocks and "
            "settle_clocks are 0");
}

int word_bytes_of(int column_bits) {
    const int bytes =
        std::max(4, static_cast<int>(std::bit_ceil(static_cast<unsigned>(column_bits + 7) / 8)));
    if (bytes > kMaxWordBytes)
        refuse(fmt::format(
            "a column of all channels has {} bits, but a word of the stream (WORD_BYTES) "
            "at most {}; take fewer channels or bits per sample",
            column_bits, 8 * kMaxWordBytes));
    return bytes;
}

/// Words of the queue of packets.
int words_of(const SensorSetup& setup, const ChipParameters& chip) {
    std::size_t most = 0;
    const ExposureSchedule& schedule = setup.schedule.schedule;
    for (std::int64_t slot = 0; slot < 3 * std::int64_t{schedule.period_slots()}; ++slot)
        most = std::max(most, count_due(schedule, slot, 0, chip.rows, chip.cols));
    const auto bits = static_cast<std::int64_t>(most) * chip.bit_depth;
    const std::int64_t words = bits / (8 * chip.word_bytes) + 16;
    if (words > kMaxWords / 2)
        refuse(fmt::format("a slot of {} samples does not fit its queue of packets (WORDS)", most));
    return std::max(1024, static_cast<int>(std::bit_ceil(static_cast<std::uint64_t>(2 * words))));
}

}  // namespace

void cut_array(SensorSetup& setup) {
    if (!setup.timing) throw InputError(setup.params.name, no_timing_text());
    ReadoutTiming& timing = *setup.timing;
    check_window(timing, setup.shape);
    if (setup.shape.rows == timing.rows && setup.shape.cols == timing.cols) return;
    setup.params.slot_us *= static_cast<double>(setup.shape.rows) / timing.rows;
    timing.code_load_clocks = code_load_clocks(timing, setup.shape.rows);
    timing.rows = setup.shape.rows;
    timing.cols = setup.shape.cols;
    setup.origin.reset();
}

ChipParameters chip_parameters(const SensorSetup& setup, const SequencerProgram& program) {
    check_sensor(setup);
    const ReadoutTiming& timing = *setup.timing;
    const bool has_groups = timing.addressing.kind == ColumnAddressing::Kind::kGroup;
    if (program.period_slots > kMaxDepth)
        refuse(fmt::format("its schedule memory (DEPTH) has at most {} slots, not {}", kMaxDepth,
                           program.period_slots));
    ChipParameters chip{.rows = timing.rows,
                        .cols = timing.cols,
                        .channels = timing.addressing.channels,
                        .columns_per_adc = timing.columns_per_adc,
                        .group_rows = has_groups ? timing.addressing.group_rows : 1,
                        .group_cols = has_groups ? timing.addressing.group_cols : 1,
                        .tile_rows = program.tile_rows,
                        .tile_cols = program.tile_cols,
                        .pixel_bits = program.bits_per_pixel,
                        .depth = program.period_slots,
                        .bit_depth = setup.params.bit_depth,
                        .dark_rows = std::max(1, timing.dark_rows)};
    chip.word_bytes = word_bytes_of(chip.channels * chip.bit_depth);
    chip.words = words_of(setup, chip);
    return chip;
}

}  // namespace stipple
