#include "decoder/sampling_operator.h"

#include <algorithm>
#include <cassert>
#include <type_traits>

#include "core/parallel.h"
#include "decoder/measurements.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

/// Calls body(first site, one past the last) for runs of sites that fit the cache.
template <typename Body>
void for_each_run(std::size_t sites, const Body& body) {
    constexpr std::size_t kRun = 256;
    parallel_for(0, static_cast<int>((sites + kRun - 1) / kRun), [&](int run) {
        const auto begin = static_cast<std::size_t>(run) * kRun;
        body(begin, std::min(begin + kRun, sites));
    });
}

/// Which of the sums that are under way a voxel belongs to.
template <bool kInterleaved>
std::size_t chain(std::uint8_t state) {
    return kInterleaved && (state & Measurements::kSecond) != 0 ? 1 : 0;
}

/// Sums of voxels whose state has a bit of `kept` stay as they are.
template <bool kInterleaved, bool kWeighted>
void sample_all(const Measurements& measurements, std::span<const float> x, std::span<float> sums,
                std::uint8_t kept) {
    const std::size_t sites = measurements.shape.sites();
    for_each_run(sites, [&](std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        std::vector<float> light(kInterleaved ? 2 * count : count, 0);
        for (std::size_t frame = 0; frame < measurements.voxels(); frame += sites)
            for (std::size_t site = begin; site < end; ++site) {
                const auto state = measurements.state[frame + site];
                float& sum = light[chain<kInterleaved>(state) * count + site - begin];
                if ((state & Measurements::kFirst) != 0) sum = 0;
                if ((state & Measurements::kOpen) != 0)
                    sum += kWeighted ? measurements.weight[frame + site] * x[frame + site]
                                     : x[frame + site];
                if ((state & kept) == 0)
                    sums[frame + site] = (state & Measurements::kLast) != 0 ? sum : 0;
            }
    });
}

template <bool kInterleaved, bool kWeighted>
void spread_all(const Measurements& measurements, std::span<const float> sums, std::span<float> x) {
    const std::size_t sites = measurements.shape.sites();
    for_each_run(sites, [&](std::size_t begin, std::size_t end) {
        const std::size_t count = end - begin;
        std::vector<float> values(kInterleaved ? 2 * count : count, 0);
        for (std::size_t frame = measurements.voxels(); frame != 0;) {
            frame -= sites;
            for (std::size_t site = begin; site < end; ++site) {
                const auto state = measurements.state[frame + site];
                float& value = values[chain<kInterleaved>(state) * count + site - begin];
                if ((state & Measurements::kLast) != 0) value = sums[frame + site];
                const float light = kWeighted ? measurements.weight[frame + site] * value : value;
                x[frame + site] = (state & Measurements::kOpen) != 0 ? light : 0;
            }
        }
    });
}

/// Calls body(interleaved, weighted), both std::bool_constant.
template <typename Body>
void with_kind(const Measurements& measurements, const Body& body) {
    const auto with_weights = [&](auto interleaved) {
        measurements.weight.empty() ? body(interleaved, std::false_type{})
                                    : body(interleaved, std::true_type{});
    };
    measurements.interleaved ? with_weights(std::true_type{}) : with_weights(std::false_type{});
}

void sample_but(std::uint8_t kept, const Measurements& measurements, std::span<const float> x,
                std::span<float> sums) {
    assert(x.size() == measurements.voxels() && sums.size() == measurements.voxels());
    with_kind(measurements, [&](auto interleaved, auto weighted) {
        sample_all<interleaved(), weighted()>(measurements, x, sums, kept);
    });
}

}  // namespace

void sample(const Measurements& measurements, std::span<const float> x, std::span<float> sums) {
    sample_but(0, measurements, x, sums);
}

void spread(const Measurements& measurements, std::span<const float> sums, std::span<float> x) {
    assert(x.size() == measurements.voxels() && sums.size() == measurements.voxels());
    with_kind(measurements, [&](auto interleaved, auto weighted) {
        spread_all<interleaved(), weighted()>(measurements, sums, x);
    });
}

void refresh_variances(Measurements& measurements, const SampleNoise& noise,
                       std::span<const float> x) {
    sample_but(Measurements::kPseudo, measurements, x, measurements.variance);
    const std::size_t sites = measurements.shape.sites();
    const bool own_noise = !measurements.dark_variance.empty();
    parallel_for(0, measurements.slots, [&](int slot) {
        const auto begin = static_cast<std::size_t>(slot) * sites;
        for (std::size_t i = begin; i < begin + sites; ++i)
            if ((measurements.state[i] & Measurements::kPseudo) == 0)
                measurements.variance[i] =
                    (measurements.state[i] & Measurements::kLast) == 0 ? 0
                    : own_noise ? measurements.variance_at(i, measurements.variance[i])
                                : noise.variance(measurements.variance[i]);
    });
    for (Measurements& other : measurements.others) refresh_variances(other, noise, x);
}

}  // namespace stipple
