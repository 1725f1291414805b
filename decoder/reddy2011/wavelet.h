#pragma once

#include <span>

#include "core/geometry.h"
#include "core/plane.h"

namespace stipple {

/// Orthonormal wavelet transform of planes, periodic, by Daubechies' wavelet with four vanishing
/// moments (8 taps). Each level halves the rows and columns of the lowpass corner. The same bits
/// for any SIMD target.
class WaveletTransform {
  public:
    /// At most `max_levels` levels; fewer if the lowpass corner would be less than 4 x 4.
    /// Precondition: a shape of `padded_shape`.
    WaveletTransform(FrameShape shape, int max_levels);

    /// `shape` with rows and columns rounded up to what all levels can halve.
    [[nodiscard]] static FrameShape padded_shape(FrameShape shape, int max_levels);

    [[nodiscard]] int levels() const { return levels_; }

    /// In place: light to coefficients, the lowpass corner first. Precondition: a plane of the
    /// shape.
    void forward(PlaneView<float> plane) const;
    /// The inverse, which is the adjoint too.
    void inverse(PlaneView<float> plane) const;

    /// Soft threshold of all coefficients outside the lowpass corner: the proximal map of threshold
    /// times the sum of their absolute values.
    void shrink(PlaneView<float> coefficients, float threshold) const;

  private:
    int rows_;
    int cols_;
    int levels_;
};

}  // namespace stipple
