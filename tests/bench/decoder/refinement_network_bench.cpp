// Products/s (items_per_second) of a refinement network of the widths 40, 64 and 96 with 15 inputs
// and 2 blocks, beside those of a loop without memory, which is the peak without fused
// multiply-add: `of_peak` is their ratio per thread, `voxels` voxels/s of wall-clock time.
// Arguments are rows, columns and threads.
//
// For a busy machine: time is the CPU time of all threads, and each iteration of the network is
// measured beside the peak, best of all iterations against best of all.
#include <benchmark/benchmark.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/bench/decoder/refinement_network_bench.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <ctime>
#include <limits>
#include <vector>

#include "core/parallel.h"
#include "decoder/learned/refinement_network.h"
#include "tests/decoder/learned/plain_network.h"
#include "tests/support/noise.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// As many chains as registers hide the latency of products and sums. Returns products per step.
std::int64_t multiply_and_add(std::int64_t steps) {
    const hn::ScalableTag<float> d;
    constexpr std::size_t kChains = 14;
    const auto factor = hn::Set(d, 0.9F);
    const auto step = hn::Set(d, 0.1F);
    hn::Vec<decltype(d)> sum[kChains];
    for (std::size_t i = 0; i < kChains; ++i) sum[i] = hn::Set(d, static_cast<float>(i));
    for (std::int64_t n = 0; n < steps; ++n)
        for (std::size_t i = 0; i < kChains; ++i) sum[i] = hn::Add(hn::Mul(sum[i], factor), step);
    for (std::size_t i = 1; i < kChains; ++i) sum[0] = hn::Add(sum[0], sum[i]);
    benchmark::DoNotOptimize(hn::GetLane(sum[0]));
    return static_cast<std::int64_t>(kChains * hn::Lanes(d));
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {
namespace {

HWY_EXPORT(multiply_and_add);

constexpr std::int64_t kPeakSteps = 1'000'000;

/// Seconds of all threads.
double cpu_seconds() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

template <typename Action>
double seconds_of(Action&& action) {
    const double start = cpu_seconds();
    action();
    return cpu_seconds() - start;
}

/// Products per second of one thread.
double measured_peak() {
    std::int64_t products = 0;
    const double seconds = seconds_of(
        [&] { products = kPeakSteps * HWY_DYNAMIC_DISPATCH(multiply_and_add)(kPeakSteps); });
    return static_cast<double>(products) / seconds;
}

void peak(benchmark::State& state) {
    std::int64_t products = 0;
    for (auto step : state)
        products += kPeakSteps * HWY_DYNAMIC_DISPATCH(multiply_and_add)(kPeakSteps);
    state.SetItemsProcessed(products);
}

void network(benchmark::State& state) {
    const int rows = static_cast<int>(state.range(0));
    const int cols = static_cast<int>(state.range(1));
    const ThreadLimit limit(static_cast<int>(state.range(2)));
    const auto net = RefinementNetwork::parse(
        safetensors_file(random_network(
            {.inputs = 15, .half = 40, .quarter = 64, .eighth = 96, .blocks = 2}, 1)),
        "weights");
    const std::size_t pixels = row_major(rows, 0, cols);
    const auto planes = noise(index(net.inputs()) * pixels, 1);
    std::vector<float> out(pixels);
    double best = std::numeric_limits<double>::max();
    double best_wall = best;
    double best_peak = 0;
    for (auto step : state) {
        const auto start = std::chrono::steady_clock::now();
        best = std::min(best, seconds_of([&] { net.refine(planes, rows, cols, out); }));
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        best_wall = std::min(best_wall, wall.count());
        state.SetIterationTime(wall.count());
        best_peak = std::max(best_peak, measured_peak());
    }
    const std::int64_t products = net.products(rows, cols);
    state.SetItemsProcessed(state.iterations() * products);
    state.counters["of_peak"] = static_cast<double>(products) / best / best_peak;
    state.counters["voxels"] = static_cast<double>(pixels) / best_wall;
}

/// A convolution of a level of the network on some rows: as short as a busy machine may leave a
/// core to one program.
void convolution(benchmark::State& state) {
    const int channels = static_cast<int>(state.range(0));
    const int rows = 16;
    const int cols = static_cast<int>(state.range(1));
    const ThreadLimit limit(1);
    const Tensor weight = random_tensor({channels, channels, 3, 3}, 1);
    const auto weights =
        stipple::convolution(3, weight.values, random_tensor({channels}, 2).values);
    const FeatureMap in(channels, rows, cols);
    FeatureMap out = in;
    double best = std::numeric_limits<double>::max();
    double best_peak = 0;
    for (auto step : state) {
        const double seconds = seconds_of([&] { convolve(weights, in, {}, out); });
        best = std::min(best, seconds);
        state.SetIterationTime(seconds);
        best_peak = std::max(best_peak, measured_peak());
    }
    const std::int64_t products = std::int64_t{9} * channels * channels * rows * cols;
    state.SetItemsProcessed(state.iterations() * products);
    state.counters["of_peak"] = static_cast<double>(products) / best / best_peak;
}

BENCHMARK(peak);
BENCHMARK(convolution)
    ->Args({40, 320})
    ->Args({64, 160})
    ->Args({96, 80})
    ->ArgNames({"", ""})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(network)
    ->Args({64, 640, 1})
    ->Args({480, 640, 1})
    ->Args({480, 640, 2})
    ->ArgNames({"", "", ""})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stipple
#endif  // HWY_ONCE
