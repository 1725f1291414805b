#pragma once

#include <algorithm>

namespace stipple {

/// argmin_z |z| + (z - v)^2 / (2 threshold)
[[nodiscard]] inline float soft_threshold(float v, float threshold) noexcept {
    return v > 0 ? std::max(v - threshold, 0.0F) : std::min(v + threshold, 0.0F);
}

/// argmin_z max(-z, 0) + (z - v)^2 / (2 threshold), for saturated samples, which light may exceed:
/// Eq. 6 of Portz et al. 2013 with 1 / rho = threshold.
[[nodiscard]] inline float one_sided_soft_threshold(float v, float threshold) noexcept {
    return v > 0 ? v : std::min(v + threshold, 0.0F);
}

}  // namespace stipple
