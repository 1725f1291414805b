#include "study/explore/trial.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace stipple {
namespace {

using Floats = std::vector<float>;

TEST(EnlargedFrameTest, EqualLightStaysEqual) {
    const Floats enlarged = enlarged_frame(Floats(std::size_t{3} * 5 * 7, 0.25F), {5, 7, 3}, 2);
    EXPECT_EQ(enlarged.size(), std::size_t{3} * 10 * 14);
    for (const float light : enlarged) EXPECT_NEAR(light, 0.25, 1e-7);  // of float
}

TEST(EnlargedFrameTest, APixelBecomesTheSincWithItsWindow) {
    Floats frame(std::size_t{1} * 13, 0);
    frame[6] = 1;
    const Floats enlarged = enlarged_frame(frame, {1, 13, 1}, 2);
    // Pixel 2 c + i lies a quarter of a pixel before or behind the middle of pixel c.
    const auto sinc = [](double x) {
        return x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
    };
    const auto weight = [&](double x) { return std::abs(x) < 3 ? sinc(x) * sinc(x / 3) : 0; };
    for (int i = 0; i < 26; ++i) {
        const double distance = (i + 0.5) / 2 - 0.5 - 6;
        double sum = 0;  // of the pixels around, which share the light
        for (int k = -8; k <= 8; ++k) sum += weight(distance - k);
        EXPECT_NEAR(enlarged[static_cast<std::size_t>(26 + i)],
                    std::max(weight(distance) / sum, 0.0), 1e-6)
            << i;
    }
}

TEST(EnlargedFrameTest, AMeanOfPixelsIsNearlyWhatItWas) {
    // A wave of 8 pixels: binned and enlarged it loses little.
    Floats fine, coarse;
    const auto light = [](double col) {
        return 1 + 0.5 * std::sin(2 * std::numbers::pi * col / 8);
    };
    for (int col = 0; col < 32; ++col) fine.push_back(static_cast<float>(light(col)));
    for (std::size_t col = 0; col < 32; col += 2) coarse.push_back((fine[col] + fine[col + 1]) / 2);
    const Floats enlarged = enlarged_frame(coarse, {1, 16, 1}, 2);
    // The mean of 2 pixels at a wave of 8 has sin(pi / 4) / (2 sin(pi / 8)) = 0.924 of its height.
    for (std::size_t col = 6; col < 26; ++col)
        EXPECT_NEAR(enlarged[32 + col], 1 + 0.924 * (light(static_cast<double>(col)) - 1), 0.01)
            << col;
}

}  // namespace
}  // namespace stipple
