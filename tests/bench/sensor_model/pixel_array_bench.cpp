// One thread, Msamples/s (items_per_second), the argument is the mean in electrons. The mean
// varies by +-10 % from sample to sample, as in an image; the pixels are every fourth or so.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "core/philox.h"
#include "sensor_model/pixel_array.h"
#include "sensor_model/poisson.h"

namespace stipple {
namespace {

constexpr std::size_t kSamples = 1U << 16U;

std::vector<std::uint32_t> random_words() {
    std::vector<std::uint32_t> words(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) words[i] = philox4x32({i, 0, 0, 0}, 1)[0];
    return words;
}

std::vector<float> means_around(double mean) {
    std::vector<float> means(kSamples);
    const std::vector<std::uint32_t> words = random_words();
    std::ranges::transform(words, means.begin(), [mean](std::uint32_t word) {
        return static_cast<float>(mean * (0.9 + 0.2 * word * 0x1p-32));
    });
    return means;
}

/// About one pixel in four, as a coded slot of the paper's exposures reads.
std::vector<std::uint32_t> sparse_pixels() {
    std::vector<std::uint32_t> pixels(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) pixels[i] = 4 * i + i % 3;
    return pixels;
}

void count_samples(benchmark::State& state) {
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}

void poisson_draws(benchmark::State& state) {
    const auto means = means_around(static_cast<double>(state.range(0)));
    const auto words = random_words();
    std::vector<std::uint32_t> counts(kSamples);
    for (auto step : state) {
        poisson(means, words, counts);
        benchmark::DoNotOptimize(counts.data());
    }
    count_samples(state);
}

void light_to_electrons(benchmark::State& state) {
    const SensorParams params;
    auto light = means_around(static_cast<double>(state.range(0)) / params.photons_per_unit);
    const auto pixels = sparse_pixels();
    const PixelArray array(params, 1);
    std::vector<float> electrons(kSamples);
    std::uint32_t slot = 0;
    for (auto step : state) {
        array.expose(light, pixels, slot++, 0, {electrons});
        benchmark::DoNotOptimize(electrons.data());
    }
    count_samples(state);
}

void std_poisson_draws(benchmark::State& state) {
    const auto means = means_around(static_cast<double>(state.range(0)));
    std::vector<std::uint32_t> counts(kSamples);
    std::mt19937_64 generator(1);
    for (auto step : state) {
        for (std::size_t i = 0; i < kSamples; ++i)
            counts[i] =
                std::poisson_distribution<std::uint32_t>(static_cast<double>(means[i]))(generator);
        benchmark::DoNotOptimize(counts.data());
    }
    count_samples(state);
}

void std_light_to_electrons(benchmark::State& state) {
    const SensorParams params;
    const auto means = means_around(static_cast<double>(state.range(0)));
    std::vector<float> electrons(kSamples);
    std::mt19937_64 generator(1);
    std::normal_distribution<double> read_noise(0, params.read_noise_e);
    for (auto step : state) {
        for (std::size_t i = 0; i < kSamples; ++i) {
            std::poisson_distribution<std::uint32_t> shot(static_cast<double>(means[i]));
            electrons[i] = static_cast<float>(
                std::min<double>(shot(generator), params.full_well_e) + read_noise(generator));
        }
        benchmark::DoNotOptimize(electrons.data());
    }
    count_samples(state);
}

BENCHMARK(poisson_draws)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);
BENCHMARK(std_poisson_draws)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);
BENCHMARK(light_to_electrons)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);
BENCHMARK(std_light_to_electrons)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);

}  // namespace
}  // namespace stipple
