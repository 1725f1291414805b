#pragma once

#include <cstdint>
#include <vector>

#include "core/index.h"
#include "stream/stream_header.h"

namespace stipple {

/// Noise of a sample in the units of FluxVideo: shot noise, read noise and rounding.
class SampleNoise {
  public:
    explicit SampleNoise(const Calibration& calibration);
    /// (r X + sigma^2) / r^2 + q^2 / 12 for an exposure with the collected light X: r electrons per
    /// unit of light, read noise sigma, one DN q.
    [[nodiscard]] float variance(float light) const {
        return constant_ + per_unit_ * (light > 0 ? light : 0);
    }

    /// Increase of the variance per unit of light: 1 / r.
    [[nodiscard]] float per_light() const { return per_unit_; }

    /// Light of one DN.
    [[nodiscard]] float one_dn() const { return one_dn_; }

  private:
    float per_unit_;
    float one_dn_;
    float constant_;
};

/// Conversion of the DN of one pixel to the light of its exposures.
class PixelResponse {
  public:
    PixelResponse(const Calibration& calibration, const CalibrationPixel& pixel);

    /// True if the sample is only a lower bound: at full scale, or so near the full well that it
    /// may have been clipped there. Read noise and rounding are added after the well, so clipped
    /// samples scatter around it. One in 3 million lies more than 5 standard deviations below and
    /// is treated as exact.
    [[nodiscard]] bool saturated(std::uint16_t dn) const { return dn >= saturation_dn_; }

    /// ((DN - black level) K^-1 / g - D n) / (r R): g relative gain, R relative responsivity, D
    /// dark electrons per slot, n open slots. For a saturated sample this is the bound at which
    /// saturation begins, independent of its noise.
    [[nodiscard]] float light(std::uint16_t dn, int open_slots) const {
        const double exact = saturated(dn) ? saturation_dn_ : dn;
        return static_cast<float>((exact - black_level_dn_) * unit_per_dn_ -
                                  dark_per_slot_ * open_slots);
    }

    [[nodiscard]] const SampleNoise& noise() const { return noise_; }
    /// Increase of the variance per open slot by dark electrons.
    [[nodiscard]] float dark_variance_per_slot() const { return dark_variance_per_slot_; }

  private:
    double black_level_dn_;
    double unit_per_dn_;
    double dark_per_slot_;  ///< light equivalent to the dark electrons of an open slot
    double saturation_dn_;
    SampleNoise noise_;
    float dark_variance_per_slot_;
};

/// The responses of all pixels of an array: those of the calibration tile, repeated.
class PixelResponses {
  public:
    explicit PixelResponses(const Calibration& calibration);

    [[nodiscard]] const PixelResponse& at(int row, int col) const {
        return responses_[row_major(row % rows_, col % cols_, cols_)];
    }

  private:
    int rows_ = 1;
    int cols_ = 1;
    std::vector<PixelResponse> responses_;
};

}  // namespace stipple
