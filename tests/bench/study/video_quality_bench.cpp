#include "study/metrics/video_quality.h"

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "study/metrics/perceptual.h"
#include "tests/support/noise.h"

namespace stipple {
namespace {

constexpr FrameShape kVga{480, 640, 3};

/// Light 0..2 of no structure.
std::vector<float> vga_noise(std::uint32_t state) {
    std::vector<float> values = noise(kVga.sites(), state);
    for (float& value : values) value *= 2;
    return values;
}

/// One colour frame in all measures. Argument: threads.
void compare_frame(benchmark::State& state) {
    const ThreadLimit limit(static_cast<int>(state.range(0)));
    const std::vector<float> result = vga_noise(1);
    const std::vector<float> reference = vga_noise(2);
    QualityMeter meter(kVga, {});
    for ([[maybe_unused]] auto unused : state) meter.add(result, reference);
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVga.sites()));
}
BENCHMARK(compare_frame)->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

void ssim_of_a_plane(benchmark::State& state) {
    const ThreadLimit limit(1);
    const std::vector<float> x = vga_noise(1);
    const std::vector<float> y = vga_noise(2);
    for ([[maybe_unused]] auto unused : state)
        benchmark::DoNotOptimize(
            ssim({x.data(), kVga.rows, kVga.cols}, {y.data(), kVga.rows, kVga.cols}));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVga.pixels()));
}
BENCHMARK(ssim_of_a_plane)->Unit(benchmark::kMillisecond);

void weighted_error_of_a_plane(benchmark::State& state) {
    const ThreadLimit limit(1);
    const std::vector<float> error = vga_noise(1);
    const CsfError meter(kVga, 60);
    for ([[maybe_unused]] auto unused : state)
        benchmark::DoNotOptimize(meter.mean_square(std::span(error).first(kVga.pixels())));
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kVga.pixels()));
}
BENCHMARK(weighted_error_of_a_plane)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stipple
