// Time to design a tile for the hardware: the lattice of a sensor with 16 channels and 1280
// columns, and a scattered tile of 64 x 64 pixels.
#include <benchmark/benchmark.h>

#include "readout/schedules/hardware_tiled.h"

namespace stipple {
namespace {

void design(benchmark::State& state, int side) {
    const HardwareTile tile{
        .addressing = {.channels = 16}, .tile_rows = side, .tile_cols = side, .array_cols = 1280};
    for (auto step : state)
        benchmark::DoNotOptimize(hardware_tiled_schedule(tile, kPaperExposureSlots, 1));
}

void lattice(benchmark::State& state) {
    design(state, 0);
}
void scatter_64x64(benchmark::State& state) {
    design(state, 64);
}

BENCHMARK(lattice)->Unit(benchmark::kMillisecond);
BENCHMARK(scatter_64x64)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stipple
