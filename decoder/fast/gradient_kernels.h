#pragma once

#include <cstddef>
#include <cstdint>

#include "core/geometry.h"

namespace stipple {

/// Step size and bound of a dual. At a voxel with primal step size s the dual step size is 1 /
/// (coupling s), and the largest norm of the dual is weight sqrt(reference_step / s).
struct DualStep {
    const float* step = nullptr;  ///< primal step size of each pixel of the frame, order (row, col)
    float coupling = 8;           ///< bound of the squared norm of the operator of all differences
    float weight = 1;             ///< above 0
    float reference_step = 1;
};

/// One frame of the dual of the spatial gradient, order (plane, row, col): `col` belongs to
/// differences to the right, `row` to those below.
struct GradientDual {
    float* col = nullptr;
    float* row = nullptr;
};

/// One frame of the array in two successive slots.
struct SlotPair {
    const float* now = nullptr;
    const float* next = nullptr;
};

// Kernels on whole frames, or on any number of pixels; every SIMD target gives the same bits.

/// dual = project(dual + sigma grad x), then gradient = grad^T dual.
void update_spatial_dual(FrameShape shape, const DualStep& dual_step, const float* x,
                         const GradientDual& dual, float* gradient) noexcept;

/// dual = project(dual + sigma (x.next - x.now)), then gradient -= dual.
void update_static_dual(FrameShape shape, const DualStep& dual_step, const SlotPair& x, float* dual,
                        float* gradient) noexcept;

/// gradient = x - step gradient
void descend(std::size_t count, const float* step, const float* x, float* gradient) noexcept;

/// extrapolated = 2 next - x, then x = next
void extrapolate(std::size_t count, const float* next, float* x, float* extrapolated) noexcept;

/// One slot of a MotionField, and the dual of its differences
///   D x = x.next at the partner, bilinear - x.now,
/// order (plane, row, col). At a pixel without confidence the dual is 0.
struct MotionLink {
    FrameShape shape;
    const std::int16_t* row_shift = nullptr;
    const std::int16_t* col_shift = nullptr;
    const std::uint8_t* confidence = nullptr;
    float* dual = nullptr;
};

// Kernels on whole frames of at least 2 x 2 pixels; every SIMD target gives the same bits.

/// dual = project(dual + sigma D x) with the largest norm of `dual_step` times confidence / 255,
/// then gradient -= dual, which is the part of D^T dual at x.now.
void update_motion_dual(const MotionLink& link, const DualStep& dual_step, const SlotPair& x,
                        float* gradient) noexcept;

/// gradient += the part of D^T dual at x.next.
void add_partner_gradient(const MotionLink& link, float* gradient) noexcept;

}  // namespace stipple
