#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/flux_video.h"

namespace stipple {

struct QualityOptions {
    int margin = 0;                   ///< frames left out at each end
    std::optional<double> max_value;  ///< clamp both sides to it first
    double peak_cd_per_m2 = 100;      ///< luminance of 1.0 for PU21
};

/// Quality of a video against its reference; all in dB except `ssim` (0..1).
struct VideoQuality {
    double psnr_db = 0;             ///< peak 1.0, pooled over everything, linear, not clamped
    double psnr_gamma_db = 0;       ///< after clamping to 0..1 and the power 1/2.2
    double psnr_frame_mean_db = 0;  ///< mean of per-frame linear PSNR
    double pu21_psnr_db = 0;        ///< PU21 banding_glare, peak = PU21(peak_cd_per_m2)
    double ssim = 0;                ///< Wang et al. 2004, after the 1/2.2 curve
};

/// Adds up quality frame by frame, so that videos longer than memory compare.
class QualityMeter {
  public:
    QualityMeter(FrameShape shape, const QualityOptions& options);
    /// Adds one frame of each; both hold shape.sites() floats, order (plane, row, col).
    void add(std::span<const float> result, std::span<const float> reference);
    /// Identical videos have infinite PSNR. \throws InputError if no frame was added.
    [[nodiscard]] VideoQuality quality() const;
};

}  // namespace stipple
