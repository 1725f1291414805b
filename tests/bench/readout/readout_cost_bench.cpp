// Slots/s (items_per_second) accounted for, 640x480 mono on the LUX1310's clocks, schedule
// `random`: a slot counted and timed row by row, and the cost of a steady slot that is known.
#include <benchmark/benchmark.h>

#include "readout/timing/readout_cost.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 480, .cols = 640, .planes = 1};

ReadoutTiming timing() {
    ReadoutTiming timing;
    timing.clock_hz = 90'000'000;
    timing.rows = 1024;
    timing.cols = 1280;
    timing.addressing.channels = 16;
    timing.io_clocks = 2;
    timing.settle_clocks = {19, 20, 25, 30, 39, 42, 62, 79, 80};
    timing.settle_margin = -1;
    timing.adc_clocks = 3;
    return timing;
}

void times_a_slot(benchmark::State& state) {
    const ExposureSchedule schedule =
        random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    const ReadoutTiming chip = timing();
    ScanCosts scans(chip, schedule, kShape);
    std::int64_t slot = 100;
    for (auto _ : state) benchmark::DoNotOptimize(scans.times(slot++, 0).end);
    state.SetItemsProcessed(state.iterations());
}

void accounts_for_steady_slots(benchmark::State& state) {
    const ExposureSchedule schedule =
        random_schedule(kShape.rows, kShape.cols, kPaperExposureSlots, 1);
    ReadoutCost cost(timing(), schedule, kShape, {});
    for (int slot = 0; slot < 30; ++slot) cost.add_next();
    for (auto _ : state) benchmark::DoNotOptimize(cost.add_next().clocks);
    state.SetItemsProcessed(state.iterations());
}

BENCHMARK(times_a_slot);
BENCHMARK(accounts_for_steady_slots);

}  // namespace
}  // namespace stipple
