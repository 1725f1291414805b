#include "decoder/pixel_transforms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

TEST(StabilisedLightTest, OnePlaneIsTwiceTheSquareRoot) {
    const std::vector<float> light = {0, 0.24F, 2, -1};
    std::vector<float> v(light.size());
    stabilise_variance(light, 1, {0.01F}, v);
    EXPECT_FLOAT_EQ(v[0], 0.2F);
    EXPECT_FLOAT_EQ(v[1], 1);
    EXPECT_FLOAT_EQ(v[2], 2 * std::sqrt(2.01F));
    EXPECT_FLOAT_EQ(v[3], v[0]) << "light below 0 counts as 0";
}

TEST(StabilisedLightTest, LightDownToTheLeastIsKept) {
    const std::vector<float> light = {-0.005F, -0.02F};
    std::vector<float> v(2);
    stabilise_variance(light, 1, {.offset = 0.01F, .min_light = -0.008F}, v);
    EXPECT_FLOAT_EQ(v[0], 2 * std::sqrt(0.005F));
    std::vector<float> back(2);
    restore_light(v, 1, {.offset = 0.01F, .min_light = -0.008F}, back);
    EXPECT_NEAR(back[0], light[0], 1e-7F);
    EXPECT_NEAR(back[1], -0.008F, 1e-7F);
}

TEST(StabilisedLightTest, GreyHasNoOpponentColours) {
    const std::vector<float> grey(6, 0.5F);
    std::vector<float> v(grey.size());
    stabilise_variance(grey, 3, {0.01F}, v);
    EXPECT_FLOAT_EQ(v[0], std::sqrt(3.0F) * 2 * std::sqrt(0.51F));
    for (std::size_t i = 2; i < v.size(); ++i) EXPECT_NEAR(v[i], 0, 1e-6F);
}

TEST(StabilisedLightTest, OpponentColoursKeepTheNorm) {
    const std::vector<float> light = random_values(30, 0, 2, 1);
    std::vector<float> v(light.size());
    stabilise_variance(light, 3, {0.02F}, v);
    for (std::size_t i = 0; i < 10; ++i) {
        double norm = 0;
        double expected = 0;
        for (std::size_t site = i; site < 30; site += 10) {
            norm += static_cast<double>(v[site]) * static_cast<double>(v[site]);
            expected += 4 * (static_cast<double>(light[site]) + 0.02);
        }
        EXPECT_NEAR(norm, expected, 1e-5);
    }
}

TEST(StabilisedLightTest, RestoringIsTheInverseAndNeverNegative) {
    for (const int planes : {1, 3}) {
        const std::vector<float> light = random_values(60, 0, 2, 2);
        std::vector<float> v(light.size());
        std::vector<float> back(light.size());
        stabilise_variance(light, planes, {0.01F}, v);
        restore_light(v, planes, {0.01F}, back);
        for (std::size_t i = 0; i < light.size(); ++i) EXPECT_NEAR(back[i], light[i], 2e-6F);
        for (float& x : v) x -= 2;
        restore_light(v, planes, {0.01F}, back);
        for (const float x : back) EXPECT_GE(x, 0);
    }
}

}  // namespace
}  // namespace stipple
