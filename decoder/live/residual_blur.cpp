// Compiled once per SIMD target by foreach_target.h, chosen at run time. The loops over pixels are
// left to the compiler's vectoriser; every target gives the same bits.
#include "decoder/live/residual_blur.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/live/residual_blur.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/index.h"

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {

// Gaussian of 1 pixel, of sum 1.
constexpr float kCentre = 0.402619947F;
constexpr float kNear = 0.244201342F;
constexpr float kFar = 0.0544886845F;
constexpr float kSquares1d = kCentre * kCentre + 2 * kNear * kNear + 2 * kFar * kFar;
constexpr float kShrink = 3 * kSquares1d * kSquares1d;  // three variances
constexpr float kMinFraction = 0.5F;                    // of the light, after a step
constexpr float kTiny = 1e-6F;                          // of precision, where there is no sample

/// `padded` has two more floats on each side of `cols`.
void blur_across(std::size_t cols, const float* HWY_RESTRICT padded, float* HWY_RESTRICT blurred) {
    for (std::size_t i = 0; i < cols; ++i)
        blurred[i] = kCentre * padded[i + 2] + kNear * (padded[i + 1] + padded[i + 3]) +
                     kFar * (padded[i] + padded[i + 4]);
}

/// Row i of `rows` is that of pixel row r - 2 + i.
void shrink_row(std::size_t cols, const float* const* precision, const float* const* weighted,
                float* HWY_RESTRICT update) {
    const auto down = [](const float* const* rows, std::size_t i) {
        return kCentre * rows[2][i] + kNear * (rows[1][i] + rows[3][i]) +
               kFar * (rows[0][i] + rows[4][i]);
    };
    for (std::size_t i = 0; i < cols; ++i) {
        const float sum = down(weighted, i);
        const float q = sum / (down(precision, i) + kTiny);
        const float z = q * sum;
        update[i] = q * z / (z + kShrink);
    }
}

void add_row(std::size_t cols, const float* HWY_RESTRICT update, float* HWY_RESTRICT light) {
    for (std::size_t i = 0; i < cols; ++i)
        light[i] = std::max(light[i] + update[i], kMinFraction * light[i]);
}

/// Sums over pairs of columns of two rows; the last pair may be half a one.
void bin_row(std::size_t cols, const float* HWY_RESTRICT above, const float* HWY_RESTRICT below,
             float* HWY_RESTRICT sums) {
    for (std::size_t i = 0; i < cols / 2; ++i)
        sums[i] = (above[2 * i] + above[2 * i + 1]) + (below[2 * i] + below[2 * i + 1]);
    if (cols % 2 != 0) sums[cols / 2] = above[cols - 1] + below[cols - 1];
}

/// Interpolates between a near and a far row of half the resolution; `padded` is for a row with one
/// more float on each side.
void widen_row(std::size_t cols, const float* HWY_RESTRICT near, const float* HWY_RESTRICT far,
               float* HWY_RESTRICT padded, float* HWY_RESTRICT update) {
    const std::size_t half = (cols + 1) / 2;
    float* HWY_RESTRICT row = padded + 1;
    for (std::size_t i = 0; i < half; ++i) row[i] = 0.75F * near[i] + 0.25F * far[i];
    padded[0] = row[0];
    row[half] = row[half - 1];
    for (std::size_t i = 0; i < cols / 2; ++i) {
        const float centre = 0.75F * padded[i + 1];
        update[2 * i] = centre + 0.25F * padded[i];
        update[2 * i + 1] = centre + 0.25F * padded[i + 2];
    }
    if (cols % 2 != 0) update[cols - 1] = 0.75F * row[half - 1] + 0.25F * padded[half - 1];
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {
namespace {

HWY_EXPORT(blur_across);
HWY_EXPORT(shrink_row);
HWY_EXPORT(add_row);
HWY_EXPORT(bin_row);
HWY_EXPORT(widen_row);

constexpr int kTaps = 5;

/// The last rows of an array, blurred along the row; 0 beyond the rim.
class RowRing {
  public:
    RowRing(FrameShape shape, std::span<const float> plane)
        : rows_(shape.rows),
          cols_(index(shape.cols)),
          plane_(plane),
          padded_(cols_ + kTaps - 1),
          blurred_(kTaps * cols_) {
        for (int row = 0; row < kTaps / 2; ++row) take(row);
    }

    /// The rows around `row`, which is one more than at the last call.
    const float* const* around(int row) {
        take(row + kTaps / 2);
        for (int i = 0; i < kTaps; ++i) pointers_[i] = blurred_row(row - kTaps / 2 + i);
        return pointers_;
    }

  private:
    float* blurred_row(int row) { return &blurred_[index((row + kTaps) % kTaps) * cols_]; }

    void take(int row) {
        float* to = blurred_row(row);
        if (row >= rows_) {
            std::fill_n(to, cols_, 0.0F);
            return;
        }
        std::copy_n(&plane_[index(row) * cols_], cols_, padded_.begin() + kTaps / 2);
        HWY_DYNAMIC_DISPATCH(blur_across)(cols_, padded_.data(), to);
    }

    int rows_;
    std::size_t cols_;
    std::span<const float> plane_;
    std::vector<float> padded_;
    std::vector<float> blurred_;
    const float* pointers_[kTaps] = {};
};

/// Calls body(row, what is to be added to it).
template <typename Body>
void for_each_update(FrameShape shape, const PlaneResiduals& residuals, const Body& body) {
    RowRing precision(shape, residuals.precision);
    RowRing weighted(shape, residuals.weighted);
    std::vector<float> update(index(shape.cols));
    for (int row = 0; row < shape.rows; ++row) {
        HWY_DYNAMIC_DISPATCH(shrink_row)
        (update.size(), precision.around(row), weighted.around(row), update.data());
        body(row, update);
    }
}

FrameShape half_of(FrameShape shape) {
    return {.rows = (shape.rows + 1) / 2, .cols = (shape.cols + 1) / 2, .planes = 1};
}

std::vector<float> binned(FrameShape shape, std::span<const float> plane) {
    const FrameShape half = half_of(shape);
    const auto cols = index(shape.cols);
    const std::vector<float> beyond(cols);
    std::vector<float> sums(half.pixels());
    for (int row = 0; row < half.rows; ++row) {
        const float* above = &plane[index(2 * row) * cols];
        const float* below = 2 * row + 1 < shape.rows ? above + cols : beyond.data();
        HWY_DYNAMIC_DISPATCH(bin_row)(cols, above, below, &sums[index(row) * index(half.cols)]);
    }
    return sums;
}

}  // namespace

void add_fine_residuals(FrameShape shape, const PlaneResiduals& residuals, std::span<float> light) {
    assert(shape.planes == 1 && light.size() == shape.pixels());
    for_each_update(shape, residuals, [&](int row, const std::vector<float>& update) {
        HWY_DYNAMIC_DISPATCH(add_row)
        (update.size(), update.data(), &light[index(row) * update.size()]);
    });
}

void add_coarse_residuals(FrameShape shape, const PlaneResiduals& residuals,
                          std::span<float> light) {
    assert(shape.planes == 1 && light.size() == shape.pixels());
    const FrameShape half = half_of(shape);
    const std::vector<float> precision = binned(shape, residuals.precision);
    const std::vector<float> weighted = binned(shape, residuals.weighted);
    std::vector<float> updates(half.pixels());
    const auto half_row = [&](int row) { return &updates[index(row) * index(half.cols)]; };
    for_each_update(half, {precision, weighted}, [&](int row, const std::vector<float>& update) {
        std::ranges::copy(update, half_row(row));
    });
    const auto cols = index(shape.cols);
    std::vector<float> padded(index(half.cols) + 2);
    std::vector<float> update(cols);
    for (int row = 0; row < shape.rows; ++row) {
        const int far = std::clamp(row / 2 + (row % 2 != 0 ? 1 : -1), 0, half.rows - 1);
        HWY_DYNAMIC_DISPATCH(widen_row)
        (cols, half_row(row / 2), half_row(far), padded.data(), update.data());
        HWY_DYNAMIC_DISPATCH(add_row)(cols, update.data(), &light[index(row) * cols]);
    }
}

}  // namespace stipple
#endif  // HWY_ONCE
