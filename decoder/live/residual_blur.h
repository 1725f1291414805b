#pragma once

#include <span>

#include "core/geometry.h"

namespace stipple {

/// Residuals of one plane in one slot, order (row, col), as SpreadResiduals.
struct PlaneResiduals {
    std::span<const float> precision;
    std::span<const float> weighted;
};

/// Adds to the light of a plane the residuals around each pixel, q = (G weighted) / (G precision),
/// G the Gaussian of 1 pixel cut at 5 x 5 pixels, 0 beyond the rim. q is shrunk to q z / (z + 3),
/// z = q^2 (G precision) / sum G^2 the square of q in its standard deviations: noise alone changes
/// little. At least half of the light remains: in a dark voxel without a sample of its own the
/// residuals of bright neighbours could make it 0. `shape` has one plane. The same bits for any
/// SIMD target.
void add_fine_residuals(FrameShape shape, const PlaneResiduals& residuals, std::span<float> light);

/// The same at half the resolution: of sums over 2 x 2 pixels, and what is added is interpolated
/// bilinearly.
void add_coarse_residuals(FrameShape shape, const PlaneResiduals& residuals,
                          std::span<float> light);

}  // namespace stipple
