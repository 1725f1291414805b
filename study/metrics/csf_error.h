#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"

namespace stipple {

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
