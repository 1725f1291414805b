#include "apps/report/quality_json.h"

#include <nlohmann/json.hpp>

namespace stipple {

nlohmann::ordered_json quality_json(const VideoQuality& quality) {
    return {{"psnr_db", quality.psnr_db},
            {"psnr_gamma_db", quality.psnr_gamma_db},
            {"psnr_frame_mean_db", quality.psnr_frame_mean_db},
            {"pu21_psnr_db", quality.pu21_psnr_db},
            {"ssim", quality.ssim}};
}

}  // namespace stipple
