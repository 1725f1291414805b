// Compiled once per SIMD target by foreach_target.h, chosen at run time. The loops over columns
// are left to the compiler's vectoriser; every target gives the same bits.
#include "decoder/fast/gradient_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/fast/gradient_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

using Index = std::size_t;

/// dual += sigma (to - from), sigma = 1 / (coupling step)
void ascend(Index cols, const DualStep& dual_step, const SlotPair& x, float* HWY_RESTRICT dual) {
    const float* HWY_RESTRICT step = dual_step.step;
    for (Index i = 0; i < cols; ++i)
        dual[i] += (x.next[i] - x.now[i]) / (dual_step.coupling * step[i]);
}

void add_squares(Index cols, const float* HWY_RESTRICT dual, float* HWY_RESTRICT squares) {
    for (Index i = 0; i < cols; ++i) squares[i] += dual[i] * dual[i];
}

/// Squared norms become the factors that bring their duals back to where they must stay.
void to_factors(Index cols, const DualStep& dual_step, float* HWY_RESTRICT squares) {
    const float* HWY_RESTRICT step = dual_step.step;
    for (Index i = 0; i < cols; ++i) {
        const float max_norm = dual_step.weight * std::sqrt(dual_step.reference_step / step[i]);
        const float norm = std::sqrt(squares[i]);
        squares[i] = norm > max_norm ? max_norm / norm : 1.0F;  // both may be 0
    }
}

void multiply(Index cols, const float* HWY_RESTRICT factor, float* HWY_RESTRICT dual) {
    for (Index i = 0; i < cols; ++i) dual[i] *= factor[i];
}

void add(Index cols, const float* HWY_RESTRICT from, float* HWY_RESTRICT to) {
    for (Index i = 0; i < cols; ++i) to[i] += from[i];
}

void subtract(Index cols, const float* HWY_RESTRICT from, float* HWY_RESTRICT to) {
    for (Index i = 0; i < cols; ++i) to[i] -= from[i];
}

/// One row of one plane: the duals of differences to the right and below grad^T.
void transpose_gradient(Index cols, bool first_row, const GradientDual& dual,
                        float* HWY_RESTRICT gradient) {
    for (Index i = 0; i < cols; ++i) gradient[i] = -(dual.col[i] + dual.row[i]);
    add(cols - 1, dual.col, gradient + 1);
    if (!first_row) add(cols, dual.row - cols, gradient);
}

void spatial_frame(FrameShape shape, const DualStep& frame_step, const float* x,
                   const GradientDual& dual, float* gradient) {
    const auto cols = static_cast<Index>(shape.cols);
    const auto planes = static_cast<Index>(shape.planes);
    const auto last_row = static_cast<Index>(shape.rows) - 1;
    std::vector<float> factor(cols);
    for (Index row = 0; row <= last_row; ++row) {
        DualStep dual_step = frame_step;
        dual_step.step += row * cols;
        std::fill(factor.begin(), factor.end(), 0.0F);
        for (Index plane = 0; plane < planes; ++plane) {
            const Index i = plane * shape.pixels() + row * cols;
            ascend(cols - 1, dual_step, {x + i, x + i + 1}, dual.col + i);
            if (row < last_row) ascend(cols, dual_step, {x + i, x + i + cols}, dual.row + i);
            add_squares(cols, dual.col + i, factor.data());
            add_squares(cols, dual.row + i, factor.data());
        }
        to_factors(cols, dual_step, factor.data());
        for (Index plane = 0; plane < planes; ++plane) {
            const Index i = plane * shape.pixels() + row * cols;
            multiply(cols, factor.data(), dual.col + i);
            multiply(cols, factor.data(), dual.row + i);
            transpose_gradient(cols, row == 0, {dual.col + i, dual.row + i}, gradient + i);
        }
    }
}

void static_frame(FrameShape shape, const DualStep& frame_step, const SlotPair& x, float* dual,
                  float* gradient) {
    const auto cols = static_cast<Index>(shape.cols);
    const auto planes = static_cast<Index>(shape.planes);
    std::vector<float> factor(cols);
    for (Index row = 0; row < static_cast<Index>(shape.rows); ++row) {
        DualStep dual_step = frame_step;
        dual_step.step += row * cols;
        std::fill(factor.begin(), factor.end(), 0.0F);
        for (Index plane = 0; plane < planes; ++plane) {
            const Index i = plane * shape.pixels() + row * cols;
            ascend(cols, dual_step, {x.now + i, x.next + i}, dual + i);
            add_squares(cols, dual + i, factor.data());
        }
        to_factors(cols, dual_step, factor.data());
        for (Index plane = 0; plane < planes; ++plane) {
            const Index i = plane * shape.pixels() + row * cols;
            multiply(cols, factor.data(), dual + i);
            subtract(cols, dual + i, gradient + i);
        }
    }
}

void descend_all(Index count, const float* HWY_RESTRICT step, const float* HWY_RESTRICT x,
                 float* HWY_RESTRICT gradient) {
    for (Index i = 0; i < count; ++i) gradient[i] = x[i] - step[i] * gradient[i];
}

void extrapolate_all(Index count, const float* HWY_RESTRICT next, float* HWY_RESTRICT x,
                     float* HWY_RESTRICT extrapolated) {
    for (Index i = 0; i < count; ++i) {
        extrapolated[i] = 2 * next[i] - x[i];
        x[i] = next[i];
    }
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(spatial_frame);
HWY_EXPORT(static_frame);
HWY_EXPORT(descend_all);
HWY_EXPORT(extrapolate_all);

void update_spatial_dual(FrameShape shape, const DualStep& dual_step, const float* x,
                         const GradientDual& dual, float* gradient) noexcept {
    HWY_DYNAMIC_DISPATCH(spatial_frame)(shape, dual_step, x, dual, gradient);
}

void update_static_dual(FrameShape shape, const DualStep& dual_step, const SlotPair& x, float* dual,
                        float* gradient) noexcept {
    HWY_DYNAMIC_DISPATCH(static_frame)(shape, dual_step, x, dual, gradient);
}

void descend(std::size_t count, const float* step, const float* x, float* gradient) noexcept {
    HWY_DYNAMIC_DISPATCH(descend_all)(count, step, x, gradient);
}

void extrapolate(std::size_t count, const float* next, float* x, float* extrapolated) noexcept {
    HWY_DYNAMIC_DISPATCH(extrapolate_all)(count, next, x, extrapolated);
}

}  // namespace stipple
#endif  // HWY_ONCE
