#include "study/metrics/perceptual.h"

#include <algorithm>
#include <cmath>

namespace stipple {

double pu21(double luminance_cd_per_m2) noexcept {
    constexpr double kP1 = 0.353487901;
    constexpr double kP2 = 0.3734658629;
    constexpr double kP3 = 8.277049286e-05;
    constexpr double kP4 = 0.9062562627;
    constexpr double kP5 = 0.09150303166;
    constexpr double kP6 = 0.9099517204;
    constexpr double kP7 = 596.3148142;
    const double y = std::pow(std::clamp(luminance_cd_per_m2, 0.005, 10000.0), kP4);
    return std::max(kP7 * (std::pow((kP1 + kP2 * y) / (1 + kP3 * y), kP5) - kP6), 0.0);
}

}  // namespace stipple
