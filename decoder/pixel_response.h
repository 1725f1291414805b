#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/index.h"
#include "decoder/response_curve.h"
#include "stream/sample_packet.h"
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
    [[nodiscard]] float lsb_light() const { return one_dn_; }

    /// True if the calibration says that there is none.
    [[nodiscard]] bool none() const { return none_; }

  private:
    float per_unit_;
    float one_dn_;
    float constant_;
    bool none_;
};

/// Conversion of the DN of one pixel to the light of its exposures.
class PixelResponse {
  public:
    PixelResponse(const Calibration& calibration, const CalibrationPixel& pixel);
    /// The response of a calibrated site; `slot_s` is the length of a slot in seconds. `curve` is
    /// null for a linear chip; else it must outlive this.
    PixelResponse(const Calibration& calibration, const CalibrationPixel& pixel,
                  const SiteCalibration& site, double slot_s, const ResponseCurve* curve = nullptr);

    /// True if the sample is only a lower bound: at full scale, or so near the full well that it
    /// may have been clipped there. Read noise and rounding are added after the well, so clipped
    /// samples scatter around it. One in 3 million lies more than 5 standard deviations below and
    /// is treated as exact.
    [[nodiscard]] bool saturated(std::uint16_t dn) const { return linear_dn(dn) >= saturation_dn_; }

    /// ((f(DN) - black level) K^-1 / g - D n) / (r R): response table f, g relative gain, R
    /// relative responsivity, D dark electrons per slot, n open slots. For a saturated sample this
    /// is the bound at which saturation begins, independent of its noise.
    [[nodiscard]] float light(std::uint16_t dn, int open_slots) const {
        const double exact = saturated(dn) ? saturation_dn_ : linear_dn(dn);
        return static_cast<float>((exact - black_level_dn_) * unit_per_dn_ -
                                  dark_per_slot_ * open_slots);
    }

    [[nodiscard]] const SampleNoise& noise() const { return noise_; }
    /// Increase of the variance per open slot by dark electrons.
    [[nodiscard]] float dark_variance_per_slot() const { return dark_variance_per_slot_; }
    /// Variance of `light` without shot noise of light: f'(DN)^2 times that of read noise and
    /// rounding, and the uncertainty of a calibration,
    ///
    ///     (Var(offset) + Var(f(DN))) / (K g r R)^2 + n^2 Var(D) / (r R)^2
    [[nodiscard]] float dark_variance(std::uint16_t dn, int open_slots) const {
        const auto n = static_cast<float>(open_slots);
        return read_variance(dn) + dark_variance_per_slot_ * n +
               (offset_variance_ + dark_rate_variance_ * n * n);
    }
    /// Increase of the variance per unit of light near `light`. The uncertain gain a of a
    /// calibration adds X^2 Var(a) / a^2, which is taken as X `light` Var(a) / a^2.
    [[nodiscard]] float variance_per_light(float light) const {
        return noise_.per_light() + relative_gain_variance_ * (light > 0 ? light : 0);
    }
    /// True if the samples say nothing of the light.
    [[nodiscard]] bool defect() const { return defect_; }

  private:
    [[nodiscard]] double linear_dn(std::uint16_t dn) const {
        return curve_ == nullptr ? dn : curve_->linear_dn(dn);
    }
    [[nodiscard]] float read_variance(std::uint16_t dn) const {
        if (curve_ == nullptr) return noise_.variance(0);
        const float slope = curve_->slope(dn);
        const auto unit = static_cast<float>(unit_per_dn_);
        return slope * slope * noise_.variance(0) + unit * unit * curve_->variance_dn2(dn);
    }

    const ResponseCurve* curve_ = nullptr;
    double black_level_dn_;
    double unit_per_dn_;
    double dark_per_slot_;  ///< light equivalent to the dark electrons of an open slot
    double saturation_dn_;  ///< linear
    SampleNoise noise_;
    float dark_variance_per_slot_;
    float offset_variance_ = 0;         ///< of `light`, as the next one
    float dark_rate_variance_ = 0;      ///< per square of open slots
    float relative_gain_variance_ = 0;  ///< Var(a) / a^2
    bool defect_ = false;
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

/// The responses of all sites of an array, calibrated if its header has a calibration of the sites.
class SiteResponses {
  public:
    /// `header` must outlive this.
    explicit SiteResponses(const StreamHeader& header);
    /// With other values of the readout, which a header with a calibration of the sites has not.
    SiteResponses(const StreamHeader& header, const ReadoutValues& values);

    [[nodiscard]] PixelResponse at(int plane, int row, int col) const;

  private:
    const StreamHeader* header_;
    PixelResponses pixels_;
    std::optional<ResponseCurve> curve_;  ///< none: linear
};

/// Counts the samples of packets that are only a lower bound (PixelResponse), and those at DN 0.
class SaturatedSamples {
  public:
    /// `header` must outlive this; packets come by slot.
    explicit SaturatedSamples(const StreamHeader& header) : header_(header), responses_(header) {}

    void add(const SamplePacket& packet);

    [[nodiscard]] std::uint64_t samples() const { return samples_; }
    [[nodiscard]] std::uint64_t saturated() const { return saturated_; }
    [[nodiscard]] std::uint64_t zeros() const { return zeros_; }

  private:
    const StreamHeader& header_;
    std::optional<SiteResponses> responses_;
    std::int64_t part_begin_ = 0;  ///< first slot of these responses
    std::uint64_t samples_ = 0;
    std::uint64_t saturated_ = 0;
    std::uint64_t zeros_ = 0;
};

}  // namespace stipple
