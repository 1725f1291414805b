#include "sensor_model/physical_pixels.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "core/philox.h"
#include "sensor_model/normal.h"
#include "sensor_model/poisson.h"
#include "sensor_model/portable_math.h"

namespace stipple {
namespace {

constexpr std::size_t kChunk = 256;  ///< samples at a time, on the stack

const SensorParams& checked(const SensorParams& params) {
    validate(params);
    return params;
}

/// Mean electrons; light without end is held finite, so that no responsivity makes it NaN.
float mean_of(const SiteParams& site, float light, float dark_slots) {
    return site.responsivity_e * std::min(light, std::numeric_limits<float>::max()) +
           site.dark_e_per_slot * dark_slots;
}

/// Standard deviation at low gain, reset noise included.
double low_gain_noise(const PhysicalTerms& terms) {
    return std::sqrt(terms.low_gain_read_noise_e * terms.low_gain_read_noise_e +
                     terms.reset_noise_e * terms.reset_noise_e);
}

/// Charge above which a pixel is read at low gain.
float gain_limit(const PhysicalTerms& terms) {
    return terms.dual_gain_limit_e == 0 ? std::numeric_limits<float>::infinity()
                                        : static_cast<float>(terms.dual_gain_limit_e);
}

}  // namespace

PhysicalPixels::PhysicalPixels(const SensorParams& params, FrameShape shape, std::uint64_t seed)
    : pattern_(checked(params), shape),
      row_noise_e_(params.physical.row_noise_e.begin(), params.physical.row_noise_e.end()),
      column_noise_e_(static_cast<float>(params.physical.column_temporal_noise_e)),
      cols_(static_cast<std::uint32_t>(shape.cols)),
      full_well_e_(static_cast<float>(params.full_well_e)),
      loss_per_e_(static_cast<float>(params.physical.response_loss / params.full_well_e)),
      dual_gain_limit_e_(gain_limit(params.physical)),
      low_gain_noise_e_(static_cast<float>(low_gain_noise(params.physical))),
      storage_e_per_row_(static_cast<float>(params.storage_dark_e() / shape.rows)),
      doublings_per_slot_(params.physical.temperature_drift_c_per_s * params.slot_us * 1e-6 /
                          params.physical.dark_doubling_c),
      shot_noise_(params.shot_noise),
      seed_(seed) {}

Charge PhysicalPixels::charge(float count, const SiteParams& site, float noise,
                              float shared_noise_e) const noexcept {
    const float held = std::min(count, full_well_e_);
    const float sigma = held > dual_gain_limit_e_ ? low_gain_noise_e_ : site.read_noise_e;
    const float read = noise * sigma + (held - loss_per_e_ * held * held);
    return {site.gain * (read + (site.offset_e + shared_noise_e)), count > full_well_e_};
}

Charge PhysicalPixels::expose_one(const SiteParams& site, float light, float dark_slots,
                                  const SampleDraws& draws) const noexcept {
    const float mean = mean_of(site, light, dark_slots) + draws.storage_e;
    const float count = shot_noise_ ? static_cast<float>(poisson_one(mean, draws.shot)) : mean;
    return charge(count, site, normal_one(draws.read), draws.shared_noise_e);
}

float PhysicalPixels::dark_factor(std::uint32_t slot) const noexcept {
    return static_cast<float>(power_of_two(std::clamp(doublings_per_slot_ * slot, -900.0, 30.0)));
}

float PhysicalPixels::waiting_e(std::uint32_t pixel, std::uint32_t plane) const noexcept {
    const bool alive = pattern_.plane(plane)[pixel].responsivity_e > 0;
    const auto row = pixel / cols_;
    return alive ? storage_e_per_row_ * static_cast<float>(row) : 0;
}

float PhysicalPixels::storage_e(std::uint32_t pixel, std::uint32_t slot,
                                std::uint32_t plane) const noexcept {
    return waiting_e(pixel, plane) * dark_factor(slot);
}

float PhysicalPixels::column_noise_e(std::uint32_t pixel, std::uint32_t slot,
                                     std::uint32_t plane) const noexcept {
    const auto words =
        philox4x32(random_address(pixel % cols_, slot, RandomPurpose::kColumnNoise, plane), seed_);
    return normal_one(words[0]) * column_noise_e_;
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

/// The row noise of each pixel; one that follows another in the same row and tap shares it.
void PhysicalPixels::fill_row_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                                    std::uint32_t plane, std::span<float> noise) const noexcept {
    if (row_noise_e_.empty()) {
        std::ranges::fill(noise, 0.0F);
        return;
    }
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

void PhysicalPixels::add_column_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                                      std::uint32_t plane, std::span<float> noise) const noexcept {
    if (column_noise_e_ == 0) return;
    for (std::size_t i = 0; i < pixel.size(); ++i)
        noise[i] += column_noise_e(pixel[i], slot, plane);
}

void PhysicalPixels::expose(const ExposedPixels& exposed, std::uint32_t slot, std::uint32_t plane,
                            const Charges& charges) const noexcept {
    assert(exposed.light.size() == exposed.pixel.size());
    assert(exposed.open_slots.size() == exposed.pixel.size());
    assert(charges.electrons.size() == exposed.pixel.size());
    assert(charges.clipped.empty() || charges.clipped.size() == exposed.pixel.size());
    const SiteParams* sites = pattern_.plane(plane);
    const SampleAddress address{.seed = seed_, .slot = slot, .plane = plane};
    std::array<std::uint32_t, kChunk> shot, read, count;
    std::array<float, kChunk> mean, noise, shared;
    const float dark = dark_factor(slot);
    for (std::size_t begin = 0; begin < exposed.pixel.size(); begin += kChunk) {
        const std::size_t n = std::min(kChunk, exposed.pixel.size() - begin);
        const auto pixel = exposed.pixel.subspan(begin, n);
        for (std::size_t i = 0; i < n; ++i)
            mean[i] = mean_of(sites[pixel[i]], exposed.light[begin + i],
                              static_cast<float>(exposed.open_slots[begin + i]) * dark);
        if (storage_e_per_row_ > 0)
            for (std::size_t i = 0; i < n; ++i) mean[i] += waiting_e(pixel[i], plane) * dark;
        sample_words(pixel, address, std::span(shot).first(n), std::span(read).first(n));
        normal(std::span(read).first(n), std::span(noise).first(n));
        fill_row_noise(pixel, slot, plane, std::span(shared).first(n));
        add_column_noise(pixel, slot, plane, std::span(shared).first(n));
        if (shot_noise_) {
            poisson(std::span(mean).first(n), std::span(shot).first(n), std::span(count).first(n));
            for (std::size_t i = 0; i < n; ++i) mean[i] = static_cast<float>(count[i]);
        }
        for (std::size_t i = 0; i < n; ++i) {
            const Charge one = charge(mean[i], sites[pixel[i]], noise[i], shared[i]);
            charges.electrons[begin + i] = one.electrons;
            if (!charges.clipped.empty()) charges.clipped[begin + i] = one.clipped ? 1 : 0;
        }
    }
}

}  // namespace stipple
