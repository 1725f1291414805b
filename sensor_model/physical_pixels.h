#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "sensor_model/charges.h"
#include "sensor_model/fixed_pattern.h"
#include "sensor_model/sample_words.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Pixels whose exposures end in the same slot; the spans have equal lengths.
struct ExposedPixels {
    std::span<const std::uint32_t> pixel;       ///< row * cols + col
    std::span<const float> light;               ///< collected, flux x slots; >= 0, not NaN
    std::span<const std::uint16_t> open_slots;  ///< slots in which each was open
};

/// The random words of one sample, and the row noise that it shares with its neighbours.
struct SampleDraws {
    std::uint32_t shot;
    std::uint32_t read;
    float row_noise_e;
};

/// Light to charge in the physical mode (docs/sensor_model.md):
///
///     electrons = g (min(Z, w) + V + offset + row noise),   Z ~ Poisson(R x + D n)
///
/// with light x, n open slots, responsivity R, D dark electrons per slot, full well w, read and
/// reset noise V and relative conversion gain g of the pixel. The result is the input of the ADC,
/// in electrons at gain 1. Row noise is one draw per (row, slot, plane, tap) at the address (row,
/// slot, kRowNoise, plane + 256 tap); taps are equal blocks of columns. As in PixelArray, the words
/// depend on seed, slot, plane and pixel only.
class PhysicalPixels {
  public:
    /// \throws InputError as `validate`. Precondition: shape.sites() > 0.
    PhysicalPixels(const SensorParams& params, FrameShape shape, std::uint64_t seed);

    /// Charge of each pixel. `slot` is the last slot of the exposures. The same bits for any list,
    /// order, and SIMD target. Precondition: plane < planes of the shape.
    void expose(const ExposedPixels& exposed, std::uint32_t slot, std::uint32_t plane,
                const Charges& charges) const noexcept;

    /// One sample with the given draws: the reference of `expose`.
    [[nodiscard]] Charge expose_one(const SiteTraits& site, float light, int open_slots,
                                    const SampleDraws& draws) const noexcept;

    /// Row noise of a sample in electrons.
    [[nodiscard]] float row_noise_e(std::uint32_t pixel, std::uint32_t slot,
                                    std::uint32_t plane) const noexcept;

    [[nodiscard]] const FixedPattern& pattern() const { return pattern_; }

  private:
    [[nodiscard]] Charge charge(float count, const SiteTraits& site, float noise,
                                float row_noise_e) const noexcept;
    void add_row_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                       std::uint32_t plane, std::span<float> noise) const noexcept;

    FixedPattern pattern_;
    std::vector<float> row_noise_e_;  ///< by tap; empty: none
    std::uint32_t cols_;
    float full_well_e_;
    bool shot_noise_;
    std::uint64_t seed_;
};

}  // namespace stipple
