#pragma once

#include "core/plane.h"

namespace stipple {

/// Structural similarity of two planes of equal size with values 0..1:
///
///     (2 mx my + C1) (2 cxy + C2) / ((mx^2 + my^2 + C1) (vx + vy + C2))
///
/// with Gaussian-weighted means m, variances v and covariance c (11 x 11, sigma 1.5), C1 = 0.01^2,
/// C2 = 0.03^2, averaged over all positions of the window inside the plane. NaN if there is none
/// (fewer than 11 rows or columns). The same bits for any thread count. Source: Wang et al., "Image
/// quality assessment: from error visibility to structural similarity", 2004, Eq. 13 to 16.
[[nodiscard]] double ssim(PlaneView<const float> x, PlaneView<const float> y);

}  // namespace stipple
