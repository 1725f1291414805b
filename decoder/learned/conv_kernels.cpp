// Compiled once per SIMD target by foreach_target.h, chosen at run time; every target gives the
// same bits. A tile of output pixels times channels stays in registers while its sums grow: per
// weight position it takes a vector of weights for each vector of channels, and one value of the
// input for each pixel.
#include "decoder/learned/conv_kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "decoder/learned/conv_kernels.cpp"
#include <hwy/foreach_target.h>  // IWYU pragma: keep

#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

#include "core/parallel.h"

#ifndef STIPPLE_CONVOLUTION_PASS
#define STIPPLE_CONVOLUTION_PASS
namespace stipple {

constexpr int kMaxTilePixels = 8;
constexpr int kMaxSide = 3;

/// out(out_step (row, col) + (out_row, out_col)) is of in(in_step (row, col) + 0..side - 1 -
/// padding).
struct ConvolutionPass {
    const ConvolutionWeights* weights = nullptr;
    const FeatureMap* in = nullptr;
    FeatureMap* out = nullptr;
    SumResult result;
    int padding = 0;
    int in_step = 1;
    int out_step = 1;
    int out_row = 0;
    int out_col = 0;

    [[nodiscard]] int rows() const { return out->rows() / out_step; }
    [[nodiscard]] int cols() const { return out->cols() / out_step; }
};

}  // namespace stipple
#endif  // STIPPLE_CONVOLUTION_PASS

HWY_BEFORE_NAMESPACE();
namespace stipple::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Lanes = hn::CappedTag<float, kBlockChannels>;
using Vector = hn::Vec<Lanes>;
constexpr int kLanes = static_cast<int>(hn::MaxLanes(Lanes()));
constexpr int kBlockVectors = kBlockChannels / kLanes;

/// Sums of `kPixels` neighbours in `kVectors` vectors of channels.
template <int kVectors, int kPixels>
struct Tile {
    Vector sum[index(kPixels)][index(kVectors)];
};

/// The vectors of the blocks from `block` on; `stride` is from one block to the next.
HWY_INLINE const float* vector_at(const ChannelBlock* block, std::size_t stride, int vector) {
    return block[index(vector / kBlockVectors) * stride].value.data() +
           vector % kBlockVectors * kLanes;
}

template <int kVectors, int kPixels>
HWY_INLINE void start(const ChannelBlock* bias, Tile<kVectors, kPixels>& tile) {
    for (int v = 0; v < kVectors; ++v)
        for (int p = 0; p < kPixels; ++p) tile.sum[p][v] = hn::Load(Lanes(), vector_at(bias, 1, v));
}

/// Adds input x weights of one weight position. The loops are unrolled, the sums stay in registers.
template <int kVectors, int kPixels, int kStep>
HWY_INLINE void add_products(const float* in, const ChannelBlock* weight, std::size_t stride,
                             Tile<kVectors, kPixels>& tile) {
    Vector weights[index(kVectors)];
    for (int v = 0; v < kVectors; ++v) weights[v] = hn::Load(Lanes(), vector_at(weight, stride, v));
    for (int p = 0; p < kPixels; ++p) {
        const Vector value = hn::Set(Lanes(), in[p * kStep * kBlockChannels]);
        for (int v = 0; v < kVectors; ++v)  // not hn::MulAdd, which rounds once on some targets
            tile.sum[p][v] = hn::Add(tile.sum[p][v], hn::Mul(value, weights[v]));
    }
}

/// The sums at the pixel of the output whose first pixel of the input is `block`, and right of it.
/// `at` tells where the pixels below the weights are: compilers that can tell themselves load
/// values for several steps, for which some sums would leave the registers.
template <int kVectors, int kPixels, int kStep>
HWY_INLINE void add_all(const ConvolutionPass& pass, const ChannelBlock* block,
                        const ChannelBlock* weight, std::span<const std::size_t> at,
                        Tile<kVectors, kPixels>& tile) {
    const int inputs = pass.weights->inputs;
    const std::size_t stride = index(inputs) * at.size();
    for (int input = 0; input < inputs; ++input) {
        const float* in = &block->value[index(input % kBlockChannels)];
        for (const std::size_t offset : at)
            add_products<kVectors, kPixels, kStep>(in + offset, weight++, stride, tile);
        if (input % kBlockChannels == kBlockChannels - 1) block += pass.in->block_stride();
    }
}

template <int kVectors, int kPixels>
HWY_INLINE void finish(const ConvolutionPass& pass, int block, int row, int col,
                       const Tile<kVectors, kPixels>& tile) {
    const Lanes d;
    FeatureMap& out = *pass.out;
    const std::size_t stride = out.block_stride();
    const int valid = std::min(kPixels, pass.cols() - col);
    for (int p = 0; p < kPixels; ++p) {
        if (p >= valid) break;
        const int out_row = pass.out_step * row + pass.out_row;
        const int out_col = pass.out_step * (col + p) + pass.out_col;
        ChannelBlock* to = out.pixel(block, out_row, out_col);
        for (int v = 0; v < kVectors; ++v) {
            Vector sum = tile.sum[p][v];
            if (pass.result.relu) sum = hn::IfThenElseZero(hn::Gt(sum, hn::Zero(d)), sum);
            if (pass.result.add != nullptr)
                sum = hn::Add(sum,
                              hn::Load(d, vector_at(pass.result.add->pixel(block, out_row, out_col),
                                                    stride, v)));
            hn::Store(sum, d, const_cast<float*>(vector_at(to, stride, v)));
        }
    }
}

/// `kBlocks` blocks of outputs from `block` on, in the rows [begin, end).
template <int kBlocks, int kPixels, int kStep>
void convolve_blocks(const ConvolutionPass& pass, int block, int begin, int end) {
    static_assert(kPixels <= kMaxTilePixels);
    const ConvolutionWeights& weights = *pass.weights;
    std::array<std::size_t, kMaxSide * kMaxSide> offsets;
    const auto at = std::span(offsets).first(index(weights.side * weights.side));
    for (int i = 0; i < weights.side * weights.side; ++i)
        at[index(i)] = (index(i / weights.side) * pass.in->row_stride() + index(i % weights.side)) *
                       kBlockChannels;
    const ChannelBlock* weight = &weights.weight[index(block) * index(weights.inputs) * at.size()];
    for (int row = begin; row < end; ++row)
        for (int col = 0; col < pass.cols(); col += kPixels) {
            Tile<kBlocks * kBlockVectors, kPixels> tile;
            start(&weights.bias[index(block)], tile);
            add_all<kBlocks * kBlockVectors, kPixels, kStep>(
                pass, pass.in->pixel(0, row * kStep - pass.padding, col * kStep - pass.padding),
                weight, at, tile);
            finish(pass, block, row, col, tile);
        }
}

/// With 16 registers of 8 lanes, 2 vectors x 6 pixels and 3 x 3 are fastest.
template <int kStep>
void convolve_rows(const ConvolutionPass& pass, int begin, int end) {
    const int blocks = static_cast<int>(pass.weights->bias.size());
    int block = 0;
    if constexpr (kBlockVectors == 1) {
        if (blocks % 2 == 1 && blocks > 1) {
            convolve_blocks<3, 3, kStep>(pass, 0, begin, end);
            block = 3;
        }
        for (; block + 2 <= blocks; block += 2)
            convolve_blocks<2, 6, kStep>(pass, block, begin, end);
    }
    constexpr int kPixels = kBlockVectors == 1 ? kMaxTilePixels : kBlockVectors == 2 ? 6 : 1;
    for (; block < blocks; ++block) convolve_blocks<1, kPixels, kStep>(pass, block, begin, end);
}

void convolve_band(const ConvolutionPass& pass, int begin, int end) {
    if (pass.in_step == 1)
        convolve_rows<1>(pass, begin, end);
    else
        convolve_rows<2>(pass, begin, end);
}

}  // namespace stipple::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace stipple {

HWY_EXPORT(convolve_band);

namespace {

/// Rows that share the weights in the cache.
constexpr int kBandRows = 4;

std::size_t blocks_of(int channels) {
    return index((channels + kBlockChannels - 1) / kBlockChannels);
}

void run(const ConvolutionPass& pass) {
    assert(pass.weights->inputs == pass.in->channels());
    assert(pass.weights->outputs == pass.out->channels());
    const int rows = pass.rows();
    parallel_for(0, (rows + kBandRows - 1) / kBandRows, [&](int band) {
        HWY_DYNAMIC_DISPATCH(convolve_band)
        (pass, band * kBandRows, std::min(rows, (band + 1) * kBandRows));
    });
}

}  // namespace

// A tile may end beyond the border on the right of the last row, and has a stride of 2 at most.
FeatureMap::FeatureMap(int channels, int rows, int cols)
    : channels_(channels),
      rows_(rows),
      cols_(cols),
      pixels_(blocks_of(channels) * block_stride() + 2 * kMaxTilePixels) {
    assert(channels >= 1 && rows >= 1 && cols >= 1);
}

ConvolutionWeights::ConvolutionWeights(int all_inputs, int all_outputs, int side_px)
    : inputs(all_inputs),
      outputs(all_outputs),
      side(side_px),
      weight(blocks_of(all_outputs) * index(all_inputs) * index(side_px * side_px)),
      bias(blocks_of(all_outputs)) {}

float& ConvolutionWeights::at(int output, int input, int row, int col) {
    const std::size_t block = index(output / kBlockChannels) * index(inputs) + index(input);
    return weight[block * index(side * side) + row_major(row, col, side)]
        .value[index(output % kBlockChannels)];
}

ConvolutionWeights convolution(int side, std::span<const float> weight,
                               std::span<const float> bias) {
    const int outputs = static_cast<int>(bias.size());
    const int inputs = static_cast<int>(weight.size()) / (outputs * side * side);
    assert(weight.size() == index(outputs) * index(inputs) * index(side * side));
    ConvolutionWeights packed(inputs, outputs, side);
    const float* value = weight.data();
    for (int output = 0; output < outputs; ++output) {
        packed.bias[index(output / kBlockChannels)].value[index(output % kBlockChannels)] =
            bias[index(output)];
        for (int input = 0; input < inputs; ++input)
            for (int i = 0; i < side * side; ++i)
                packed.at(output, input, i / side, i % side) = *value++;
    }
    return packed;
}

TransposedWeights transposed_convolution(std::span<const float> weight,
                                         std::span<const float> bias) {
    constexpr std::size_t kPixels = 4;
    const std::size_t outputs = bias.size();
    const std::size_t inputs = weight.size() / (outputs * kPixels);
    assert(weight.size() == inputs * outputs * kPixels);
    const auto of_pixel = [&](std::size_t pixel) {
        std::vector<float> values(outputs * inputs);
        for (std::size_t output = 0; output < outputs; ++output)
            for (std::size_t input = 0; input < inputs; ++input)
                values[output * inputs + input] =
                    weight[(input * outputs + output) * kPixels + pixel];
        return convolution(1, values, bias);
    };
    return {of_pixel(0), of_pixel(1), of_pixel(2), of_pixel(3)};
}

void convolve(const ConvolutionWeights& weights, const FeatureMap& in, const SumResult& result,
              FeatureMap& out) {
    assert(weights.side == 3 && in.rows() == out.rows() && in.cols() == out.cols());
    run({.weights = &weights, .in = &in, .out = &out, .result = result, .padding = 1});
}

void convolve_to_half(const ConvolutionWeights& weights, const FeatureMap& in, FeatureMap& out) {
    assert(weights.side == 2 && in.rows() == 2 * out.rows() && in.cols() == 2 * out.cols());
    run({.weights = &weights, .in = &in, .out = &out, .result = {}, .in_step = 2});
}

void convolve_to_double(const TransposedWeights& weights, const FeatureMap& in,
                        const SumResult& result, FeatureMap& out) {
    assert(2 * in.rows() == out.rows() && 2 * in.cols() == out.cols());
    for (int i = 0; i < 4; ++i)
        run({.weights = &weights[index(i)],
             .in = &in,
             .out = &out,
             .result = result,
             .out_step = 2,
             .out_row = i / 2,
             .out_col = i % 2});
}

}  // namespace stipple
#endif  // HWY_ONCE
