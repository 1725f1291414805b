#include "sensor_model/physical_pixels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include "core/philox.h"
#include "sensor_model/normal.h"
#include "sensor_model/poisson.h"

namespace stipple {
namespace {

constexpr std::size_t kChunk = 256;  ///< samples at a time, on the stack

const SensorParams& checked(const SensorParams& params) {
    validate(params);
    return params;
}

/// Mean electrons; light without end is held finite, so that no responsivity makes it NaN.
float mean_of(const SiteTraits& site, float light, int open_slots) {
    return site.responsivity_e * std::min(light, std::numeric_limits<float>::max()) +
           site.dark_e_per_slot * static_cast<float>(open_slots);
}

}  // namespace

PhysicalPixels::PhysicalPixels(const SensorParams& params, FrameShape shape, std::uint64_t seed)
    : pattern_(checked(params), shape),
      row_noise_e_(params.physical.row_noise_e.begin(), params.physical.row_noise_e.end()),
      cols_(static_cast<std::uint32_t>(shape.cols)),
      full_well_e_(static_cast<float>(params.full_well_e)),
      shot_noise_(params.shot_noise),
      seed_(seed) {}

Charge PhysicalPixels::charge(float count, const SiteTraits& site, float noise,
                              float row_noise_e) const noexcept {
    const float read = noise * site.read_noise_e + std::min(count, full_well_e_);
    return {site.gain * (read + (site.offset_e + row_noise_e)), count > full_well_e_};
}

Charge PhysicalPixels::expose_one(const SiteTraits& site, float light, int open_slots,
                                  const SampleDraws& draws) const noexcept {
    const float mean = mean_of(site, light, open_slots);
    const float count = shot_noise_ ? static_cast<float>(poisson_one(mean, draws.shot)) : mean;
    return charge(count, site, normal_one(draws.read), draws.row_noise_e);
}

float PhysicalPixels::row_noise_e(std::uint32_t pixel, std::uint32_t slot,
                                  std::uint32_t plane) const noexcept {
    if (row_noise_e_.empty()) return 0;
    const std::uint32_t row = pixel / cols_;
    const auto tap = static_cast<std::uint32_t>(std::uint64_t{pixel - row * cols_} *
                                                row_noise_e_.size() / cols_);
    const auto words =
        philox4x32(random_address(row, slot, RandomPurpose::kRowNoise, plane + 256 * tap), seed_);
    return normal_one(words[0]) * row_noise_e_[tap];
}

/// Adds the row noise of each pixel; one that follows another in the same row and tap shares it.
void PhysicalPixels::add_row_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                                   std::uint32_t plane, std::span<float> noise) const noexcept {
    if (row_noise_e_.empty()) return;
    const auto taps = static_cast<std::uint32_t>(row_noise_e_.size());
    std::uint32_t first = 1, end = 0;  // pixels of the row and tap of `shared`
    float shared = 0;
    for (std::size_t i = 0; i < pixel.size(); ++i) {
        if (pixel[i] < first || pixel[i] >= end) {
            const std::uint32_t row = pixel[i] / cols_;
            const auto tap =
                static_cast<std::uint32_t>(std::uint64_t{pixel[i] - row * cols_} * taps / cols_);
            const auto begin_of = [&](std::uint64_t t) {  // first column with col taps / cols >= t
                return row * cols_ + static_cast<std::uint32_t>((t * cols_ + taps - 1) / taps);
            };
            first = begin_of(tap);
            end = begin_of(tap + std::uint64_t{1});
            shared = row_noise_e(pixel[i], slot, plane);
        }
        noise[i] = shared;
    }
}

void PhysicalPixels::expose(const ExposedPixels& exposed, std::uint32_t slot, std::uint32_t plane,
                            const Charges& charges) const noexcept {
    assert(exposed.light.size() == exposed.pixel.size());
    assert(exposed.open_slots.size() == exposed.pixel.size());
    assert(charges.electrons.size() == exposed.pixel.size());
    assert(charges.clipped.empty() || charges.clipped.size() == exposed.pixel.size());
    const SiteTraits* sites = pattern_.plane(plane);
    const SampleAddress address{.seed = seed_, .slot = slot, .plane = plane};
    std::array<std::uint32_t, kChunk> shot, read, count;
    std::array<float, kChunk> mean, noise, rows{};
    for (std::size_t begin = 0; begin < exposed.pixel.size(); begin += kChunk) {
        const std::size_t n = std::min(kChunk, exposed.pixel.size() - begin);
        const auto pixel = exposed.pixel.subspan(begin, n);
        for (std::size_t i = 0; i < n; ++i)
            mean[i] =
                mean_of(sites[pixel[i]], exposed.light[begin + i], exposed.open_slots[begin + i]);
        sample_words(pixel, address, std::span(shot).first(n), std::span(read).first(n));
        normal(std::span(read).first(n), std::span(noise).first(n));
        add_row_noise(pixel, slot, plane, std::span(rows).first(n));
        if (shot_noise_) {
            poisson(std::span(mean).first(n), std::span(shot).first(n), std::span(count).first(n));
            for (std::size_t i = 0; i < n; ++i) mean[i] = static_cast<float>(count[i]);
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Charge one = charge(mean[i], sites[pixel[i]], noise[i], rows[i]);
            charges.electrons[begin + i] = one.electrons;
            if (!charges.clipped.empty()) charges.clipped[begin + i] = one.clipped ? 1 : 0;
        }
    }
}

}  // namespace stipple
