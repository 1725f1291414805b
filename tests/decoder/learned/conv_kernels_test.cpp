#include "decoder/learned/conv_kernels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "core/parallel.h"
#include "tests/decoder/learned/plain_network.h"
#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

struct Size {
    int inputs, outputs, rows, cols;
};

/// Tiles that end at the edge and beyond it, one block of channels to five, blocks not full.
constexpr Size kSizes[] = {{1, 8, 1, 1},  {8, 4, 3, 13},  {3, 16, 5, 12},  {12, 24, 2, 7},
                           {9, 40, 6, 6}, {20, 32, 9, 5}, {52, 40, 11, 19}};

std::vector<std::uint32_t> bits(const std::vector<float>& values) {
    std::vector<std::uint32_t> result;
    for (const float value : values) result.push_back(std::bit_cast<std::uint32_t>(value));
    return result;
}

Planes random_planes(int channels, int rows, int cols, std::uint32_t seed) {
    Planes planes(channels, rows, cols);
    planes.values = random_values(planes.values.size(), -1, 1, seed);
    return planes;
}

void expect_bits(const FeatureMap& found, const Planes& wanted, const std::string& name) {
    EXPECT_EQ(bits(planes_of(found).values), bits(wanted.values))
        << name << ": " << wanted.channels << " x " << wanted.rows << " x " << wanted.cols;
}

/// The kernels may read the border, and all other kernels rely on it.
void expect_border_of_zeros(const FeatureMap& map) {
    const auto is_zero = [&](int row, int col) {
        const auto& value = map.pixel(0, row, col)->value;
        return std::ranges::all_of(value, [](float v) { return v == 0; });
    };
    for (int row = -1; row <= map.rows(); ++row)
        EXPECT_TRUE(is_zero(row, -1) && is_zero(row, map.cols())) << row;
    for (int col = -1; col <= map.cols(); ++col)
        EXPECT_TRUE(is_zero(-1, col) && is_zero(map.rows(), col)) << col;
}

TEST(ConvKernelsTest, ConvolutionHasTheBitsOfItsDefinition) {
    for (const auto& [inputs, outputs, rows, cols] : kSizes) {
        const Tensor weight = random_tensor({outputs, inputs, 3, 3}, 1);
        const Tensor bias = random_tensor({outputs}, 2);
        const Planes in = random_planes(inputs, rows, cols, 3);
        const Planes old = random_planes(outputs, rows, cols, 4);
        const Planes sum = plain_convolution(weight, bias, in, 1, 1);
        const auto weights = convolution(3, weight.values, bias.values);
        const FeatureMap map = map_of(in);
        for_each_simd_target([&](const std::string& target) {
            FeatureMap out = map_of(old);
            convolve(weights, map, {}, out);
            expect_bits(out, sum, target);
            convolve(weights, map, {.relu = true}, out);
            expect_bits(out, plain_relu(sum), target);
            FeatureMap residual = map_of(old);
            convolve(weights, map, {.add = &residual}, residual);
            expect_bits(residual, plain_sum(sum, old), target);
            convolve(weights, map, {.relu = true, .add = &out}, residual);
            expect_bits(residual, plain_sum(plain_relu(sum), plain_relu(sum)), target);
            expect_border_of_zeros(residual);
        });
    }
}

TEST(ConvKernelsTest, ConvolutionToHalfHasTheBitsOfItsDefinition) {
    for (const auto& [inputs, outputs, rows, cols] : kSizes) {
        const Tensor weight = random_tensor({outputs, inputs, 2, 2}, 1);
        const Tensor bias = random_tensor({outputs}, 2);
        const Planes in = random_planes(inputs, 2 * rows, 2 * cols, 3);
        const Planes sum = plain_convolution(weight, bias, in, 2, 0);
        const auto weights = convolution(2, weight.values, bias.values);
        for_each_simd_target([&](const std::string& target) {
            FeatureMap out(sum.channels, sum.rows, sum.cols);
            convolve_to_half(weights, map_of(in), out);
            expect_bits(out, sum, target);
            expect_border_of_zeros(out);
        });
    }
}

TEST(ConvKernelsTest, ConvolutionToDoubleHasTheBitsOfItsDefinition) {
    for (const auto& [inputs, outputs, rows, cols] : kSizes) {
        const Tensor weight = random_tensor({inputs, outputs, 2, 2}, 1);
        const Tensor bias = random_tensor({outputs}, 2);
        const Planes in = random_planes(inputs, rows, cols, 3);
        const Planes skip = random_planes(outputs, 2 * rows, 2 * cols, 4);
        const Planes sum = plain_transposed(weight, bias, in);
        const auto weights = transposed_convolution(weight.values, bias.values);
        for_each_simd_target([&](const std::string& target) {
            FeatureMap out(sum.channels, sum.rows, sum.cols);
            convolve_to_double(weights, map_of(in), {}, out);
            expect_bits(out, sum, target);
            out = map_of(skip);
            convolve_to_double(weights, map_of(in), {.add = &out}, out);
            expect_bits(out, plain_sum(sum, skip), target);
            expect_border_of_zeros(out);
        });
    }
}

/// (1, 1, 1) over a picture of ones counts the pixels below a square of weights.
TEST(ConvKernelsTest, ThereAreZerosBeyondTheBorder) {
    const auto weights = convolution(3, std::vector<float>(9, 1), std::vector<float>{0.5F});
    FeatureMap out(1, 3, 4);
    convolve(weights, map_of({1, 3, 4, std::vector<float>(12, 1)}), {}, out);
    EXPECT_EQ(planes_of(out).values, (std::vector<float>{4.5F, 6.5F, 6.5F, 4.5F, 6.5F, 9.5F, 9.5F,
                                                         6.5F, 4.5F, 6.5F, 6.5F, 4.5F}));
}

TEST(ConvKernelsTest, ReluMakesWhatIsNoNumberZero) {
    const auto weights = convolution(3, std::vector<float>(9, 1), std::vector<float>{0});
    const Planes in(1, 1, 2, {HUGE_VALF, -HUGE_VALF});
    for_each_simd_target([&](const std::string& target) {
        FeatureMap out(1, 1, 2);
        convolve(weights, map_of(in), {.relu = true}, out);
        EXPECT_EQ(planes_of(out).values, (std::vector<float>{0, 0})) << target;
    });
}

TEST(ConvKernelsTest, AnyNumberOfThreadsGivesTheSameBits) {
    const Tensor weight = random_tensor({24, 16, 3, 3}, 1);
    const auto weights = convolution(3, weight.values, random_tensor({24}, 2).values);
    const FeatureMap in = map_of(random_planes(16, 61, 23, 3));
    std::vector<float> first;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        FeatureMap out(24, 61, 23);
        convolve(weights, in, {}, out);
        if (first.empty()) first = planes_of(out).values;
        EXPECT_EQ(bits(planes_of(out).values), bits(first)) << threads << " threads";
    }
}

}  // namespace
}  // namespace stipple
