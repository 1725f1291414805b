#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/index.h"

namespace stipple {

inline constexpr int kBlockChannels = 8;

/// Eight channels of a pixel.
struct alignas(32) ChannelBlock {
    std::array<float, kBlockChannels> value = {};
};

/// Channels of a picture, order (block of 8 channels, row, col, channel of the block), with a
/// border of one pixel of zeros around each block. Channels that fill up the last block are 0.
class FeatureMap {
  public:
    /// All zeros. Precondition: channels, rows, cols >= 1.
    FeatureMap(int channels, int rows, int cols);

    [[nodiscard]] int channels() const { return channels_; }
    [[nodiscard]] int rows() const { return rows_; }
    [[nodiscard]] int cols() const { return cols_; }
    [[nodiscard]] std::size_t row_stride() const { return index(cols_) + 2; }  ///< in pixels
    [[nodiscard]] std::size_t block_stride() const { return (index(rows_) + 2) * row_stride(); }

    /// Row and column may be those of the border, -1 and `rows()` or `cols()`.
    [[nodiscard]] ChannelBlock* pixel(int block, int row, int col) {
        return &pixels_[offset(block, row, col)];
    }
    [[nodiscard]] const ChannelBlock* pixel(int block, int row, int col) const {
        return &pixels_[offset(block, row, col)];
    }
    [[nodiscard]] float& at(int channel, int row, int col) {
        return pixel(channel / kBlockChannels, row, col)->value[index(channel % kBlockChannels)];
    }
    [[nodiscard]] float at(int channel, int row, int col) const {
        return pixel(channel / kBlockChannels, row, col)->value[index(channel % kBlockChannels)];
    }

  private:
    [[nodiscard]] std::size_t offset(int block, int row, int col) const {
        return index(block) * block_stride() + index(row + 1) * row_stride() + index(col + 1);
    }

    int channels_, rows_, cols_;
    std::vector<ChannelBlock> pixels_;  ///< and some behind the last one, which kernels may read
};

/// Weights of a convolution, as the kernels read them.
struct ConvolutionWeights {
    int inputs = 0;
    int outputs = 0;
    int side = 0;                      ///< of the square of weights, in pixels
    std::vector<ChannelBlock> weight;  ///< order (block of outputs, input, row, col, output)
    std::vector<ChannelBlock> bias;    ///< order (block of outputs, output)

    /// Zeros.
    ConvolutionWeights(int all_inputs, int all_outputs, int side_px);
    [[nodiscard]] float& at(int output, int input, int row, int col);
};

/// `weight` has the order (output, input, row, col) of torch.nn.Conv2d.
/// Precondition: the sizes match.
[[nodiscard]] ConvolutionWeights convolution(int side, std::span<const float> weight,
                                             std::span<const float> bias);

/// A transposed convolution of 2 x 2 weights with stride 2: a convolution of 1 x 1 for each pixel
/// of a square of the output, order (row, col).
using TransposedWeights = std::array<ConvolutionWeights, 4>;

/// `weight` has the order (input, output, row, col) of torch.nn.ConvTranspose2d.
/// Precondition: the sizes match.
[[nodiscard]] TransposedWeights transposed_convolution(std::span<const float> weight,
                                                       std::span<const float> bias);

/// From the sum of a convolution to its result: max(sum, 0) if `relu`, then plus `add`, which may
/// be the output itself.
struct SumResult {
    bool relu = false;
    const FeatureMap* add = nullptr;  ///< of the shape of the output
};

// A sum is bias + input x weight + ..., by input channel, row, column, each product and each sum
// rounded to float; a sum that is not a number is 0 after `relu`. So the bits are the same on every
// SIMD target, for any number of threads and compiler. Rows are computed in parallel.
// Preconditions: inputs and outputs are the channels of the maps, the output is another map than
// the input.

/// 3 x 3 weights, zeros beyond the border; maps of one size.
void convolve(const ConvolutionWeights& weights, const FeatureMap& in, const SumResult& result,
              FeatureMap& out);

/// 2 x 2 weights with stride 2: out(row, col) is of in(2 row + 0..1, 2 col + 0..1). Precondition:
/// `in` has twice the rows and columns of `out`.
void convolve_to_half(const ConvolutionWeights& weights, const FeatureMap& in, FeatureMap& out);

/// Transposed, with stride 2: out(2 row + i, 2 col + j) is of in(row, col) and weights (i, j).
/// Precondition: `out` has twice the rows and columns of `in`.
void convolve_to_double(const TransposedWeights& weights, const FeatureMap& in,
                        const SumResult& result, FeatureMap& out);

}  // namespace stipple
