#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "sensor_model/fixed_pattern.h"
#include "sensor_model/pixel_array.h"
#include "sensor_model/sample_words.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Pixels whose exposures end in the same slot; the spans have equal lengths.
struct ExposedPixels {
    std::span<const std::uint32_t> pixel;       ///< row * cols + col
    std::span<const float> light;               ///< collected, flux x slots; >= 0, not NaN
    std::span<const std::uint16_t> open_slots;  ///< slots in which each was open
};

/// The random words of one sample, the noise that it shares with its row and its column, and the
/// mean dark signal of its wait.
struct SampleDraws {
    std::uint32_t shot;
    std::uint32_t read;
    float shared_noise_e;
    float storage_e = 0;
};

/// Light to charge in the physical mode (docs/sensor_model.md):
///
///     electrons = g (Q + V + offset + row noise + column noise)
///     Q = min(Z, w) (1 - e min(Z, w) / w),   Z ~ Poisson(R x + D n + S row / rows)
///
/// with light x, n open slots, responsivity R, D dark electrons per slot, S electrons per scan of
/// the storage node, full well w, response loss e, read and reset noise V and relative conversion
/// gain g of the pixel. The result is the input of the ADC, in electrons at gain 1. V has the read
/// noise `low_gain_read_noise_e` where min(Z, w) exceeds `dual_gain_limit_e`. Row noise is one draw
/// per (row, slot, plane, tap) at the address (row, slot, kRowNoise, plane + 256 tap); taps are
/// equal blocks of columns. Column noise is one draw per (column, slot, plane) at (column, slot,
/// kColumnNoise, plane). As in PixelArray, the words depend on seed, slot, plane and pixel only.
class PhysicalPixels {
  public:
    /// \throws InputError as `validate`. Precondition: shape.sites() > 0.
    PhysicalPixels(const SensorParams& params, FrameShape shape, std::uint64_t seed);

    /// Charge of each pixel. `slot` is the last slot of the exposures. The same bits for any list,
    /// order, and SIMD target. Precondition: plane < planes of the shape.
    void expose(const ExposedPixels& exposed, std::uint32_t slot, std::uint32_t plane,
                const Charges& charges) const noexcept;

    /// One sample with the given draws: the reference of `expose`. `dark_slots` is the number of
    /// open slots times `dark_factor`.
    [[nodiscard]] Charge expose_one(const SiteParams& site, float light, float dark_slots,
                                    const SampleDraws& draws) const noexcept;

    /// Row noise of a sample in electrons.
    [[nodiscard]] float row_noise_e(std::uint32_t pixel, std::uint32_t slot,
                                    std::uint32_t plane) const noexcept;

    /// Mean dark signal of the storage node, in electrons: a row waits row / rows of the scan for
    /// its readout. Nothing in dead pixels.
    [[nodiscard]] float storage_e(std::uint32_t pixel, std::uint32_t slot,
                                  std::uint32_t plane) const noexcept;

    /// Temporal column noise of a sample in electrons.
    [[nodiscard]] float column_noise_e(std::uint32_t pixel, std::uint32_t slot,
                                       std::uint32_t plane) const noexcept;

    /// Dark current of an exposure that ends in `slot`, relative to that at `temperature_c`; at
    /// most 2^30.
    [[nodiscard]] float dark_factor(std::uint32_t slot) const noexcept;

    /// Light that fills the well of a pixel; infinite without responsivity.
    [[nodiscard]] float full_well_light(const SiteParams& site) const noexcept {
        return full_well_e_ / site.responsivity_e;
    }

    [[nodiscard]] const FixedPattern& pattern() const { return pattern_; }

  private:
    /// `storage_e` before the drift of the temperature.
    [[nodiscard]] float waiting_e(std::uint32_t pixel, std::uint32_t plane) const noexcept;
    [[nodiscard]] Charge charge(float count, const SiteParams& site, float noise,
                                float shared_noise_e) const noexcept;
    void fill_row_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                        std::uint32_t plane, std::span<float> noise) const noexcept;
    void add_column_noise(std::span<const std::uint32_t> pixel, std::uint32_t slot,
                          std::uint32_t plane, std::span<float> noise) const noexcept;

    FixedPattern pattern_;
    std::vector<float> row_noise_e_;  ///< by tap; empty: none
    float column_noise_e_;
    std::uint32_t cols_;
    float full_well_e_;
    float loss_per_e_;         ///< of the response
    float dual_gain_limit_e_;  ///< infinite: one gain
    float low_gain_noise_e_;
    float storage_e_per_row_;
    double doublings_per_slot_;  ///< of the dark current
    bool shot_noise_;
    std::uint64_t seed_;
};

}  // namespace stipple
