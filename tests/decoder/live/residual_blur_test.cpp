#include "decoder/live/residual_blur.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/index.h"
#include "tests/decoder/recordings.h"
#include "tests/support/simd_targets.h"

namespace stipple {
namespace {

using AddResiduals = void (*)(FrameShape, const PlaneResiduals&, std::span<float>);
constexpr AddResiduals kBoth[] = {add_fine_residuals, add_coarse_residuals};

/// Weights of the Gaussian of 1 pixel at -2 ... 2, of sum 1.
std::vector<double> taps() {
    std::vector<double> taps;
    double sum = 0;
    for (int i = -2; i <= 2; ++i) sum += taps.emplace_back(std::exp(-i * i / 2.0));
    for (double& tap : taps) tap /= sum;
    return taps;
}

/// Sum of the squares of the 25 weights.
double squares() {
    double sum = 0;
    for (const double tap : taps()) sum += tap * tap;
    return sum * sum;
}

TEST(ResidualBlurTest, WithoutSamplesTheLightStays) {
    const FrameShape shape{.rows = 5, .cols = 7, .planes = 1};
    const std::vector<float> none(shape.pixels());
    for (const AddResiduals add : kBoth) {
        std::vector<float> light(shape.pixels(), 0.3F);
        add(shape, {none, none}, light);
        EXPECT_EQ(light, std::vector<float>(shape.pixels(), 0.3F));
    }
}

TEST(ResidualBlurTest, OneResidualIsSharedByThePixelsThatSeeIt) {
    const FrameShape shape{.rows = 9, .cols = 9, .planes = 1};
    std::vector<float> precision(shape.pixels()), weighted(shape.pixels());
    const std::size_t middle = row_major(4, 4, 9);
    precision[middle] = 1e4F;
    weighted[middle] = 1e4F * 0.5F;
    std::vector<float> light(shape.pixels());
    add_fine_residuals(shape, {precision, weighted}, light);
    for (int row = 0; row < 9; ++row)
        for (int col = 0; col < 9; ++col) {
            const bool near = std::abs(row - 4) <= 2 && std::abs(col - 4) <= 2;
            double expected = 0;
            if (near) {
                const double weight = taps()[index(row - 2)] * taps()[index(col - 2)];
                const double z = 0.25 * 1e4 * weight / squares();
                expected = 0.5 * z / (z + 3);
            }
            EXPECT_NEAR(light[row_major(row, col, 9)], expected, 1e-5) << row << ' ' << col;
        }
}

TEST(ResidualBlurTest, EqualResidualsChangeAllPixelsAlikeButAtTheRim) {
    // z = q^2 p / sum G^2, p the precision of a pixel, or of the four of a cell.
    const float q = 0.02F, p = 1e4F;
    for (const FrameShape shape : {FrameShape{.rows = 15, .cols = 18, .planes = 1},
                                   FrameShape{.rows = 16, .cols = 17, .planes = 1}})
        for (const AddResiduals add : kBoth) {
            std::vector<float> light(shape.pixels(), 0.5F);
            add(shape,
                {std::vector<float>(shape.pixels(), p), std::vector<float>(shape.pixels(), p * q)},
                light);
            const double z = static_cast<double>(q) * static_cast<double>(q * p) / squares() *
                             (add == add_coarse_residuals ? 4 : 1);
            for (int row = 6; row + 6 < shape.rows; ++row)
                for (int col = 6; col + 6 < shape.cols; ++col)
                    EXPECT_NEAR(light[row_major(row, col, shape.cols)],
                                0.5 + static_cast<double>(q) * z / (z + 3), 1e-6);
        }
}

TEST(ResidualBlurTest, WhatMayBeNoiseIsLeft) {
    // A residual of half its standard deviation, blurred: z = 0.25 / squares at each pixel of a
    // plane of one value, so 0.25 of a deviation of the mean is asked for here.
    const FrameShape shape{.rows = 20, .cols = 20, .planes = 1};
    const float p = 1e4F;
    const auto q = static_cast<float>(0.5 * std::sqrt(squares() / 1e4));
    std::vector<float> light(shape.pixels(), 0.5F);
    add_fine_residuals(
        shape, {std::vector<float>(shape.pixels(), p), std::vector<float>(shape.pixels(), p * q)},
        light);
    EXPECT_NEAR(light[row_major(10, 10, 20)], 0.5 + static_cast<double>(q) * 0.25 / 3.25, 1e-6);
}

TEST(ResidualBlurTest, HalfOfTheLightRemains) {
    const FrameShape shape{.rows = 3, .cols = 3, .planes = 1};
    for (const AddResiduals add : kBoth) {
        std::vector<float> light(shape.pixels(), 0.1F);
        add(shape, {std::vector<float>(9, 1e4F), std::vector<float>(9, -1e4F)}, light);
        EXPECT_EQ(light, std::vector<float>(9, 0.05F));
    }
}

TEST(ResidualBlurTest, GivesTheSameBitsOnAnySimdTarget) {
    const FrameShape shape{.rows = 13, .cols = 37, .planes = 1};
    const std::vector<float> precision = random_values(shape.pixels(), 0, 1e4F, 1);
    const std::vector<float> weighted = random_values(shape.pixels(), -1e3F, 1e3F, 2);
    for (const AddResiduals add : kBoth) {
        std::vector<float> first;
        for_each_simd_target([&](const std::string& target) {
            std::vector<float> light = random_values(shape.pixels(), 0, 1, 3);
            add(shape, {precision, weighted}, light);
            if (first.empty()) first = light;
            EXPECT_EQ(light, first) << target;
        });
    }
}

}  // namespace
}  // namespace stipple
