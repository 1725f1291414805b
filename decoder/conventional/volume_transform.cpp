#include "decoder/conventional/volume_transform.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

#include "core/index.h"

namespace stipple {
namespace {

/// cos(pi numerator / denominator), from its series within the first octant.
double cosine(int numerator, int denominator) {
    int n = numerator % (2 * denominator);
    if (n > denominator) n = 2 * denominator - n;  // cos(2 pi - x) = cos x
    const bool negative = 2 * n > denominator;     // cos(pi - x) = -cos x
    if (negative) n = denominator - n;
    const double x = std::numbers::pi * n / denominator;  // up to pi / 2
    double term = 1;
    double sum = 1;
    for (int k = 1; k <= 12; ++k) {
        term *= -x * x / ((2 * k - 1) * (2 * k));
        sum += term;
    }
    return negative ? -sum : sum;
}

SquareMatrix transposed(const SquareMatrix& matrix) {
    SquareMatrix result = matrix;
    for (int row = 0; row < matrix.side; ++row)
        for (int col = 0; col < matrix.side; ++col)
            result.values[row_major(col, row, matrix.side)] =
                matrix.values[row_major(row, col, matrix.side)];
    return result;
}

/// Multiplies each vector of `matrix.side` rows of `width` values by the matrix.
void multiply(const SquareMatrix& matrix, std::size_t width, std::span<float> values) {
    const std::size_t side = index(matrix.side);
    std::array<float, index(kMaxGroupVolumes) * kBlockPixels * kMaxVolumeFrames> product;
    assert(side * width <= product.size());
    for (float* first = values.data(); first < values.data() + values.size();
         first += side * width) {
        std::fill_n(product.begin(), side * width, 0.0F);
        for (std::size_t row = 0; row < side; ++row)
            for (std::size_t k = 0; k < side; ++k) {
                const float factor = matrix.values[row * side + k];
                const float* in = first + k * width;
                float* out = product.data() + row * width;
                for (std::size_t i = 0; i < width; ++i) out[i] += factor * in[i];
            }
        std::copy_n(product.begin(), side * width, first);
    }
}

void transpose_blocks(std::span<float> values) {
    for (float* block = values.data(); block < values.data() + values.size(); block += kBlockPixels)
        for (int row = 0; row < kBlockSide; ++row)
            for (int col = 0; col < row; ++col)
                std::swap(block[row * kBlockSide + col], block[col * kBlockSide + row]);
}

/// Of rows and columns; blocks are left transposed, which the inverse undoes.
void transform_blocks(const SquareMatrix& matrix, std::span<float> values) {
    multiply(matrix, kBlockSide, values);
    transpose_blocks(values);
    multiply(matrix, kBlockSide, values);
}

}  // namespace

SquareMatrix dct_matrix(int side) {
    SquareMatrix matrix{side, std::vector<float>(index(side) * index(side))};
    for (int row = 0; row < side; ++row)
        for (int col = 0; col < side; ++col)
            matrix.values[row_major(row, col, side)] = static_cast<float>(
                std::sqrt((row == 0 ? 1.0 : 2.0) / side) * cosine(row * (2 * col + 1), 2 * side));
    return matrix;
}

SquareMatrix haar_matrix(int side) {
    assert(std::has_single_bit(static_cast<unsigned>(side)));
    SquareMatrix matrix{side, std::vector<float>(index(side) * index(side))};
    const double mean = 1 / std::sqrt(static_cast<double>(side));
    std::fill_n(matrix.values.begin(), side, static_cast<float>(mean));
    int row = 1;
    for (int length = side; length > 1; length /= 2)
        for (int begin = 0; begin < side; begin += length, ++row) {
            const auto value = static_cast<float>(1 / std::sqrt(static_cast<double>(length)));
            for (int i = 0; i < length; ++i)
                matrix.values[row_major(row, begin + i, side)] = i < length / 2 ? value : -value;
        }
    return matrix;
}

VolumeTransform::VolumeTransform() {
    const auto pair = [](const SquareMatrix& matrix) { return Pair{matrix, transposed(matrix)}; };
    space_ = pair(dct_matrix(kBlockSide));
    for (int frames = 1; frames <= kMaxVolumeFrames; ++frames)
        time_[index(frames)] = pair(dct_matrix(frames));
    for (int volumes = 1; volumes <= kMaxGroupVolumes; volumes *= 2)
        group_[index(volumes)] = pair(haar_matrix(volumes));
}

void VolumeTransform::forward(int volumes, int frames, std::span<float> group) const {
    assert(group.size() == index(volumes) * index(frames) * kBlockPixels);
    transform_blocks(space_[0], group);
    multiply(time_[index(frames)][0], kBlockPixels, group);
    multiply(group_[index(volumes)][0], index(frames) * kBlockPixels, group);
}

void VolumeTransform::inverse(int volumes, int frames, std::span<float> group) const {
    assert(group.size() == index(volumes) * index(frames) * kBlockPixels);
    multiply(group_[index(volumes)][1], index(frames) * kBlockPixels, group);
    multiply(time_[index(frames)][1], kBlockPixels, group);
    transform_blocks(space_[1], group);
}

}  // namespace stipple
