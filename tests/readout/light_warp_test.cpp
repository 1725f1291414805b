#include "readout/light_warp.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/index.h"

namespace stipple {
namespace {

constexpr FrameShape kShape{.rows = 12, .cols = 17, .planes = 3};

/// Light that is linear in row and column, with another level in each plane.
std::vector<float> slope() {
    std::vector<float> light(kShape.sites());
    for (std::size_t i = 0; i < light.size(); ++i) {
        const std::size_t plane = i / kShape.pixels(), pixel = i % kShape.pixels();
        light[i] = static_cast<float>(100 * plane + 3 * (pixel / 17) + pixel % 17);
    }
    return light;
}

TEST(LightWarpTest, CopiesLightByWholePixels) {
    const auto light = slope();
    LightWarp warp(Homography::shift({.row = 2, .col = -5}), kShape);
    const auto warped = warp(light);
    for (int row = 2; row < kShape.rows; ++row)
        for (int col = 0; col + 5 < kShape.cols; ++col)
            for (std::size_t plane = 0; plane < kShape.sites(); plane += kShape.pixels())
                ASSERT_EQ(warped[plane + row_major(row, col, 17)],
                          light[plane + row_major(row - 2, col + 5, 17)]);
    LightWarp none({}, kShape);
    EXPECT_EQ(none(light).data(), light.data());
}

TEST(LightWarpTest, InterpolatesASlopeExactly) {
    // Bilinear interpolation is exact for linear light; the weights are rounded to 2^-24.
    const auto light = slope();
    LightWarp warp(Homography::shift({.row = 0.25, .col = 0.7}), kShape);
    const auto warped = warp(light);
    for (int row = 1; row < kShape.rows; ++row)
        for (int col = 1; col < kShape.cols; ++col)
            ASSERT_NEAR(warped[row_major(row, col, 17)], 3 * (row - 0.25) + (col - 0.7), 1e-4);
}

TEST(LightWarpTest, TakesTheEdgeBeyondTheFrame) {
    const auto light = slope();
    LightWarp warp(Homography::shift({.row = 4, .col = 0}), kShape);
    const auto warped = warp(light);
    for (int row = 0; row < 4; ++row)
        EXPECT_EQ(warped[row_major(row, 6, 17)], light[row_major(0, 6, 17)]);
}

}  // namespace
}  // namespace stipple
