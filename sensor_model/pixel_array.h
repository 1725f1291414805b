#pragma once

#include <cstdint>
#include <span>

#include "sensor_model/sample_words.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Charge of a pixel at the end of an exposure, as the input of the ADC.
struct Charge {
    float electrons = 0;   ///< noise included; may be negative
    bool clipped = false;  ///< the full well has limited it
};

/// Charges of a list of pixels.
struct Charges {
    std::span<float> electrons;
    std::span<std::uint8_t> clipped = {};  ///< 0 or 1 per pixel; empty: not wanted
};

/// Parameters of the charge-domain part of Eq. 1, in the types of the kernel.
struct PixelModel {
    float electrons_per_unit;  ///< r
    float full_well_e;         ///< w
    float read_noise_e;        ///< sigma
    bool shot_noise;
};

/// Charge of one sample with the given random words: the reference of `PixelArray::expose`.
/// Precondition: light >= 0, not NaN.
[[nodiscard]] Charge expose_one(const PixelModel& model, float light, std::uint32_t shot_word,
                                std::uint32_t read_word) noexcept;

/// Light to charge: the charge-domain part of the paper's Eq. 1, for a list of samples:
///
///     electrons = min(Z, w) + V,   Z ~ Poisson(r x),   V ~ N(0, sigma^2)
///
/// x is the sum of flux over the exposure's slots, added in slot order (a sum of Poisson variables
/// is Poisson, so one draw per exposure is enough). The random words depend on seed, slot, plane
/// and pixel only, not on the order or the other samples of the list. The result can be negative.
///
/// Not modelled: see SensorParams. ColumnAdc converts the charge to DN.
class PixelArray {
  public:
    /// \throws InputError as `validate`.
    PixelArray(const SensorParams& params, std::uint64_t seed);

    /// Charge i is that of pixel `pixel[i]` (row * cols + col) when it has collected `light[i]`,
    /// in units of flux x slots. `slot` is the last slot of the exposure.
    /// Precondition: equal lengths; light >= 0, not NaN; plane < 2^24.
    void expose(std::span<const float> light, std::span<const std::uint32_t> pixel,
                std::uint32_t slot, std::uint32_t plane, const Charges& charges) const noexcept;

  private:
    PixelModel model_;
    std::uint64_t seed_;
};

}  // namespace stipple
