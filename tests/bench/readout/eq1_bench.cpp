// The whole of Eq. 1, light to DN, Msamples/s (items_per_second) of one thread; the argument is the
// mean in electrons, which varies by +-10 % from sample to sample. `std_light_to_dn` is the same
// with the standard library; eq1_peers.py runs both beside NumPy.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "core/philox.h"
#include "readout/column_adc.h"
#include "sensor_model/pixel_array.h"

namespace stipple {
namespace {

constexpr std::size_t kSamples = 1U << 16U;

std::vector<float> light_around(double mean_e, const SensorParams& params) {
    std::vector<float> light(kSamples);
    for (std::uint32_t i = 0; i < kSamples; ++i) {
        const double share = 0.9 + 0.2 * philox4x32({i, 0, 0, 0}, 1)[0] * 0x1p-32;
        light[i] = static_cast<float>(mean_e * share / params.photons_per_unit);
    }
    return light;
}

void light_to_dn(benchmark::State& state) {
    const SensorParams params;
    const auto light = light_around(static_cast<double>(state.range(0)), params);
    std::vector<std::uint32_t> pixels(kSamples);
    std::iota(pixels.begin(), pixels.end(), 0U);
    const PixelArray array(params, 1);
    const ColumnAdc adc(params);
    std::vector<float> electrons(kSamples);
    std::vector<std::uint16_t> dn(kSamples);
    std::uint32_t slot = 0;
    for (auto iteration : state) {
        array.expose(light, pixels, slot++, 0, {electrons});
        adc.convert(electrons, dn);
        benchmark::DoNotOptimize(dn.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}

void std_light_to_dn(benchmark::State& state) {
    const SensorParams params;
    const auto light = light_around(static_cast<double>(state.range(0)), params);
    std::vector<std::uint16_t> dn(kSamples);
    std::mt19937_64 generator(1);
    std::normal_distribution<double> read_noise(0, params.read_noise_e);
    for (auto iteration : state) {
        for (std::size_t i = 0; i < kSamples; ++i) {
            std::poisson_distribution<std::uint32_t> shot(static_cast<double>(light[i]) *
                                                          params.photons_per_unit);
            const double charge =
                std::min<double>(shot(generator), params.full_well_e) + read_noise(generator);
            dn[i] = static_cast<std::uint16_t>(
                std::lround(255 * std::clamp(charge / params.full_scale_e, 0.0, 1.0)));
        }
        benchmark::DoNotOptimize(dn.data());
    }
    state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(kSamples));
}

BENCHMARK(light_to_dn)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);
BENCHMARK(std_light_to_dn)->Arg(1)->Arg(10)->Arg(100)->Arg(1000)->Arg(8000);

}  // namespace
}  // namespace stipple
