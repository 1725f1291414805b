// One thread, Msamples/s (items_per_second), the argument is the mean in electrons; as
// pixel_array_bench, with the terms of the physical mode.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sensor_model/physical_pixels.h"

namespace stipple {
namespace {

constexpr std::size_t kSamples = 1U << 16U;
constexpr FrameShape kShape{.rows = 512, .cols = 512, .planes = 1};

void light_to_electrons(benchmark::State& state, const PhysicalTerms& terms) {
    const PhysicalPixels pixels({.mode = SensorMode::kPhysical, .physical = terms}, kShape, 1);
    std::vector<std::uint32_t> pixel(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) pixel[i] = 4 * i + i % 3;
    std::vector<float> light(kSamples), electrons(kSamples);
    for (std::size_t i = 0; i < kSamples; ++i)
        light[i] = static_cast<float>(state.range(0)) *
                   (0.9F + 0.2F * static_cast<float>(i * 7919 % 1000) / 1000) / 1000;
    const std::vector<std::uint16_t> open_slots(kSamples, 1);
    std::uint32_t slot = 0;
    for (auto step : state) {
        pixels.expose({pixel, light, open_slots}, slot++, 0, {electrons});
        benchmark::DoNotOptimize(electrons.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}

void no_terms(benchmark::State& state) {
    light_to_electrons(state, {});
}
void every_term(benchmark::State& state) {
    light_to_electrons(state, {.dark_current_e_per_s = 100,
                               .dsnu_e = 2,
                               .prnu = 0.01,
                               .read_noise_spread = 0.2,
                               .reset_noise_e = 5,
                               .row_noise_e = {2, 3},
                               .column_noise_e = 1});
}

BENCHMARK(no_terms)->Arg(10)->Arg(1000)->Arg(8000);
BENCHMARK(every_term)->Arg(10)->Arg(1000)->Arg(8000);

}  // namespace
}  // namespace stipple
