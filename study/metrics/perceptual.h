#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"
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

/// PU21 value of an absolute luminance in cd/m2 (variant banding_glare): equal differences are
/// about equally visible. It is 0 at 0.005 cd/m2, 256 at 100 and 595 at 10 000; luminance is
/// clamped to this range. Source: Mantiuk and Azimi, "PU21: a novel perceptually uniform encoding
/// for adapting existing quality metrics for HDR", Image Coding Symposium 2021.
[[nodiscard]] double pu21(double luminance_cd_per_m2) noexcept;

/// Contrast sensitivity of the eye to a grating of these frequencies in cycles per degree, 1 at its
/// maximum, which is at 7.89 along rows or columns:
///
///     A(f) = 2.6 (0.0192 + 0.114 f) exp(-(0.114 f)^1.1), f = |(x, y)| / (0.15 cos(4 theta) + 0.85)
///
/// Below the maximum it is 1, so that an error of the mean counts in full. Sources: Mannos and
/// Sakrison, "The effects of a visual fidelity criterion on the encoding of images", 1974, for A;
/// Damera-Venkata et al., "Image quality assessment based on a degradation model", 2000, for its
/// dependence on the angle theta and its low-pass form.
[[nodiscard]] double contrast_sensitivity(double x_cycles_per_degree,
                                          double y_cycles_per_degree) noexcept;

/// Mean square of an image after each spatial frequency was weighted with `contrast_sensitivity`:
/// the visible part of an error that is given in perceptually uniform units.
///
/// Not modelled: masking by the content, the dependence of the contrast sensitivity on luminance
/// (the curve is that of about 100 cd/m2) and on eccentricity, glare, colour, and motion. The image
/// counts as one period of an endless pattern.
class CsfError {
  public:
    /// An image of rows x cols of `shape`, seen so that a degree of visual angle has so many
    /// pixels. \throws InputError unless pixels_per_degree > 0.
    CsfError(FrameShape shape, double pixels_per_degree);

    /// By row and column, rows * cols values. The same bits for any thread count.
    [[nodiscard]] double mean_square(std::span<const float> image) const;

  private:
    int rows_;
    int cols_;
    std::vector<double> squared_weights_;  ///< by column and row of the spectrum
};

}  // namespace stipple
