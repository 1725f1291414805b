#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "study/metrics/perceptual.h"

namespace stipple {

struct QualityOptions {
    int margin = 0;                        ///< frames omitted at each end
    std::optional<double> max_value = {};  ///< both videos are clipped to it first
    double peak = 1;                       ///< peak light of linear PSNR and, as luminance, of PU21
    double unit_cd_per_m2 = 100;           ///< luminance of light 1.0, for PU21
    bool pu21_ssim = false;                ///< compute it, which takes as long as `ssim`
    /// Compute `pu21_csf_psnr_db` for a viewer to whom a degree of visual angle has so many pixels.
    std::optional<double> pixels_per_degree = {};
};

/// The margin of demo, reports and benchmarks, as less is known of the light at the ends: 4 frames,
/// fewer if they would leave none of `frames`.
[[nodiscard]] constexpr int usual_margin(int frames) {
    return std::min(4, (frames - 1) / 2);
}

/// Quality of a video against its reference; all in dB except `ssim` (up to 1). Identical videos
/// have infinite PSNR.
struct VideoQuality {
    double psnr_db = 0;        ///< from the mean square error of all values, linear, not clamped
    double psnr_gamma_db = 0;  ///< after clamping to 0..1 and the power 1/2.2
    double psnr_frame_mean_db = 0;  ///< mean of per-frame linear PSNR
    double pu21_psnr_db = 0;        ///< PU21 of each plane, its peak that of `peak`
    double ssim = 0;  ///< after clamping and 1/2.2; mean over frames and planes; see perceptual.h
    /// SSIM of the PU21 values of luminance (Rec. 709), for a range of 256, as its authors take it;
    /// mean over frames.
    std::optional<double> pu21_ssim = {};
    /// As `pu21_psnr_db` but of luminance, with its error weighted by the contrast sensitivity of
    /// the eye (CsfError).
    std::optional<double> pu21_csf_psnr_db = {};
};

/// Accumulates quality frame by frame, so that videos larger than memory can be compared. The same
/// bits for any thread count.
class QualityMeter {
  public:
    /// \throws InputError if the shape is empty, the margin negative, or `max_value`,
    /// `peak` or `unit_cd_per_m2` not above 0.
    QualityMeter(FrameShape shape, const QualityOptions& options);

    /// Adds one frame of each; both hold shape.sites() finite floats, order (plane, row, col).
    void add(std::span<const float> result, std::span<const float> reference);
    /// \throws InputError if no frame is left between the margins.
    [[nodiscard]] VideoQuality quality() const;
    /// The same of each frame between the margins alone, in order.
    [[nodiscard]] std::vector<VideoQuality> frame_qualities() const;
    /// The same of the frame that was added last, in a margin or not. Precondition: there is one.
    [[nodiscard]] VideoQuality last_quality() const;

  private:
    /// Sums of squared errors on three scales.
    struct SquaredErrors {
        double linear = 0;
        double gamma = 0;
        double pu21 = 0;
        SquaredErrors& operator+=(const SquaredErrors& other);
    };
    struct FrameQuality {
        SquaredErrors errors;
        double ssim = 0;
        double pu21_ssim = 0;
        double csf_mean_square = 0;  ///< of PU21 values
    };
    void add_luminance(std::span<const float> result, std::span<const float> reference,
                       FrameQuality& frame) const;
    [[nodiscard]] std::vector<float> pu21_luminance(std::span<const float> light) const;
    [[nodiscard]] std::span<const FrameQuality> counted() const;
    [[nodiscard]] VideoQuality quality_of(std::span<const FrameQuality> frames) const;
    SquaredErrors add_row(std::span<const float> result, std::span<const float> reference, int row);

    FrameShape shape_;
    QualityOptions options_;
    std::optional<CsfError> csf_;
    std::vector<FrameQuality> frames_;  ///< all frames: the margin at the end is known last
    std::vector<float> result_gamma_;   ///< the present frame after the 1/2.2 curve
    std::vector<float> reference_gamma_;
};

}  // namespace stipple
