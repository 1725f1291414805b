#pragma once

#include "core/geometry.h"

namespace stipple {

/// How a dual moves and where it must stay. The dual step at a voxel is 1 / (coupling * step): its
/// primal step times all that touches it.
struct DualStep {
    const float* step = nullptr;  ///< primal step of each pixel of the frame, order (row, col)
    float coupling = 8;           ///< bound of the squared norm of all differences together
    float weight = 1;             ///< largest norm of the dual, above 0
};

/// One frame of the dual of the spatial gradient, order (plane, row, col): `col` belongs to
/// differences to the right, `row` to those below.
struct GradientDual {
    float* col = nullptr;
    float* row = nullptr;
};

/// The same frame of the array in two slots.
struct SlotPair {
    const float* now = nullptr;
    const float* next = nullptr;
};

// Kernels on whole frames; every SIMD target gives the same bits.

/// dual = project(dual + sigma grad x), then gradient = grad^T dual.
void update_spatial_dual(FrameShape shape, const DualStep& dual_step, const float* x,
                         const GradientDual& dual, float* gradient) noexcept;

/// dual = project(dual + sigma (x.next - x.now)), then gradient -= dual.
void update_static_dual(FrameShape shape, const DualStep& dual_step, const SlotPair& x, float* dual,
                        float* gradient) noexcept;

}  // namespace stipple
