#pragma once

#include <cstdint>

#include "core/geometry.h"
#include "decoder/fast/gradient_kernels.h"

namespace stipple {

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
