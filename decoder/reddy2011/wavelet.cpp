#include "decoder/reddy2011/sparse_frames.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <vector>

#include "core/index.h"
#include "decoder/data_prox.h"

namespace stipple {
namespace {

constexpr std::size_t kTaps = 8;

/// I. Daubechies, "Orthonormal bases of compactly supported wavelets", 1988, N = 4.
constexpr std::array<float, kTaps> kLow{
    0.23037781330885523F,  0.7148465705525415F,   0.6308807679295904F,   -0.02798376941698385F,
    -0.18703481171888114F, 0.030841381835986965F, 0.032883011666982945F, -0.010597401784997278F};

/// The quadrature mirror of the lowpass.
constexpr std::array<float, kTaps> kHigh{kLow[7], -kLow[6], kLow[5], -kLow[4],
                                         kLow[3], -kLow[2], kLow[1], -kLow[0]};

/// The smallest side of the lowpass corner.
constexpr int kMinCorner = 4;

int levels_of(FrameShape shape, int max_levels) {
    int levels = 0;
    while (levels < max_levels && std::min(shape.rows, shape.cols) >> (levels + 1) >= kMinCorner)
        ++levels;
    return levels;
}

/// Values that taps reach beyond the end of a line, where it begins again.
constexpr std::size_t kBeyond = kTaps - 2;

/// Analysis of a line, in place: low to its first half, high to the second. `work` has kBeyond more
/// values.
void split_line(std::span<float> line, std::span<float> work) {
    const std::size_t half = line.size() / 2;
    std::ranges::copy(line, work.begin());
    for (std::size_t i = line.size(); i < work.size(); ++i) work[i] = work[i - line.size()];
    for (std::size_t k = 0; k < half; ++k) {
        float low = 0;
        float high = 0;
        for (std::size_t tap = 0; tap < kTaps; ++tap) {
            low += kLow[tap] * work[2 * k + tap];
            high += kHigh[tap] * work[2 * k + tap];
        }
        line[k] = low;
        line[half + k] = high;
    }
}

void join_line(std::span<float> line, std::span<float> work) {
    const std::size_t half = line.size() / 2;
    std::ranges::fill(work, 0.0F);
    for (std::size_t k = 0; k < half; ++k)
        for (std::size_t tap = 0; tap < kTaps; ++tap)
            work[2 * k + tap] += kLow[tap] * line[k] + kHigh[tap] * line[half + k];
    for (std::size_t i = work.size(); i-- > line.size();) work[i - line.size()] += work[i];
    std::ranges::copy(work.first(line.size()), line.begin());
}

/// The corner of a plane that a level transforms.
struct Corner {
    PlaneView<float> plane;
    int rows;
    int cols;

    [[nodiscard]] std::span<float> row(int row) const { return plane.row(row).first(index(cols)); }
};

template <typename Line>
void for_each_line(const Corner& corner, const Line& transform) {
    std::vector<float> work(index(corner.cols) + kBeyond);
    for (int row = 0; row < corner.rows; ++row) transform(corner.row(row), work);
}

/// to += factor * from
void add_row(float factor, std::span<const float> from, std::span<float> to) {
    for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

/// Replaces the rows of a corner by sums of rows: add(k, tap, row that is tap k sees, rows of the
/// result) for all k and taps.
template <typename Add>
void sum_rows(const Corner& corner, const Add& add) {
    const auto cols = index(corner.cols);
    std::vector<float> sums(index(corner.rows) * cols);
    const auto sum_row = [&](int row) { return std::span(sums).subspan(index(row) * cols, cols); };
    for (int k = 0; k < corner.rows / 2; ++k)
        for (int tap = 0; tap < static_cast<int>(kTaps); ++tap)
            add(k, index(tap), (2 * k + tap) % corner.rows, sum_row);
    for (int row = 0; row < corner.rows; ++row)
        std::ranges::copy(sum_row(row), corner.row(row).begin());
}

void split_rows(const Corner& corner) {
    const int half = corner.rows / 2;
    sum_rows(corner, [&](int k, std::size_t tap, int row, const auto& sum_row) {
        add_row(kLow[tap], corner.row(row), sum_row(k));
        add_row(kHigh[tap], corner.row(row), sum_row(half + k));
    });
}

void join_rows(const Corner& corner) {
    const int half = corner.rows / 2;
    sum_rows(corner, [&](int k, std::size_t tap, int row, const auto& sum_row) {
        add_row(kLow[tap], corner.row(k), sum_row(row));
        add_row(kHigh[tap], corner.row(half + k), sum_row(row));
    });
}

}  // namespace

WaveletTransform::WaveletTransform(FrameShape shape, int max_levels)
    : rows_(shape.rows), cols_(shape.cols), levels_(levels_of(shape, max_levels)) {
    assert(padded_shape(shape, max_levels) == shape);
}

FrameShape WaveletTransform::padded_shape(FrameShape shape, int max_levels) {
    const int levels = levels_of(shape, max_levels);
    const auto padded = [unit = 1 << levels](int side) { return (side + unit - 1) / unit * unit; };
    shape.rows = padded(shape.rows);
    shape.cols = padded(shape.cols);
    // The larger frame may have room for one more level.
    return levels_of(shape, max_levels) == levels ? shape : padded_shape(shape, max_levels);
}

void WaveletTransform::forward(PlaneView<float> plane) const {
    for (int level = 0; level < levels_; ++level) {
        const Corner corner{plane, rows_ >> level, cols_ >> level};
        for_each_line(corner, split_line);
        split_rows(corner);
    }
}

void WaveletTransform::inverse(PlaneView<float> plane) const {
    for (int level = levels_; level-- > 0;) {
        const Corner corner{plane, rows_ >> level, cols_ >> level};
        join_rows(corner);
        for_each_line(corner, join_line);
    }
}

void WaveletTransform::shrink(PlaneView<float> coefficients, float threshold) const {
    if (levels_ == 0) return;
    for (int row = 0; row < rows_; ++row) {
        const int kept = row < rows_ >> levels_ ? cols_ >> levels_ : 0;
        for (float& value : coefficients.row(row).subspan(index(kept)))
            value = soft_threshold(value, threshold);
    }
}

}  // namespace stipple
