#include "core/hdr_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace stipple {
namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

// ITU-R BT.2408-4, tables 1 and 2 (percent of the PQ and HLG signals), and the 10-bit codes of
// SMPTE ST 2084 that its annex lists: 0 cd/m2 is 0, 10 000 cd/m2 is 1.
TEST(HdrCurvesTest, PqHasThePublishedValues) {
    const std::pair<float, double> published[] = {{0.0F, 0.0},      {100.0F, 0.508},
                                                  {203.0F, 0.58},   {1000.0F, 0.75},
                                                  {4000.0F, 0.903}, {10000.0F, 1.0}};
    for (const auto& [cd, signal] : published) {
        EXPECT_NEAR(pq_signal(cd), signal, 0.002) << cd;  // published in percent of 2 digits
    }
    EXPECT_NEAR(pq_signal(100), 0.50808, 1e-5);  // the formula, in 50 digits
    EXPECT_NEAR(pq_signal(1), 0.14995, 1e-5);
    EXPECT_EQ(pq_signal(20'000), pq_signal(10'000));
    EXPECT_EQ(pq_signal(-1), pq_signal(0));
}

TEST(HdrCurvesTest, HlgHasThePublishedValues) {
    // BT.2100-2: half the signal at 1/12 of the light. BT.2408-4: a grey card of 18 % at 38 %,
    // HDR Reference White at 75 %, with white at 0.265 of the light.
    EXPECT_FLOAT_EQ(hlg_signal(1.0F / 12), 0.5F);
    EXPECT_NEAR(hlg_signal(1), 1.0, 1e-6);
    EXPECT_EQ(hlg_signal(0), 0.0F);
    EXPECT_NEAR(hlg_signal(0.265F), 0.75, 1e-3);
    EXPECT_NEAR(hlg_signal(0.18F * 0.265F), 0.38, 2e-3);
    EXPECT_NEAR(hlg_light_of_luminance(kReferenceWhiteCd), 0.265, 1e-3);
    EXPECT_EQ(hlg_light_of_luminance(1000), 1.0);
}

TEST(HdrCurvesTest, TheInverseCurvesUndoThem) {
    for (int code = 0; code <= 1023; ++code) {
        const float signal = static_cast<float>(code) / 1023;
        // The power of 79 multiplies relative errors of 2^-24, twice and in some steps: 3e-5 at
        // most, a thirtieth of a step of 10 bits.
        EXPECT_NEAR(pq_signal(pq_luminance(signal)), signal, 3e-5) << code;
        EXPECT_NEAR(hlg_signal(hlg_light(signal)), signal, 1e-6) << code;
    }
}

TEST(HdrCurvesTest, Bt709IsTheInverseOfTheCurveOfCameras) {
    for (const double light : {0.0, 0.01, 0.018, 0.1, 0.5, 1.0}) {
        const double signal = light < 0.018 ? 4.5 * light : 1.099 * std::pow(light, 0.45) - 0.099;
        EXPECT_NEAR(bt709_light(static_cast<float>(signal)), light, 1e-4);
    }
}

/// Of linear R, G, B to X, Y, Z from chromaticities, with white D65 (ITU-R BT.2100-2, table 2).
Matrix to_xyz(const std::array<std::array<double, 2>, 3>& xy) {
    constexpr double kWhiteX = 0.3127 / 0.3290;
    constexpr double kWhiteZ = (1 - 0.3127 - 0.3290) / 0.3290;
    Matrix matrix{};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto [x, y] = std::pair(xy[i][0], xy[i][1]);
        matrix[0][i] = x / y;
        matrix[1][i] = 1;
        matrix[2][i] = (1 - x - y) / y;
    }
    // Gains that make R = G = B = 1 white, by Cramer's rule.
    const auto determinant = [](const Matrix& m) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
               m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    Matrix scaled = matrix;
    for (std::size_t i = 0; i < 3; ++i) {
        Matrix replaced = matrix;
        replaced[0][i] = kWhiteX;
        replaced[1][i] = 1;
        replaced[2][i] = kWhiteZ;
        for (auto& row : scaled) row[i] *= determinant(replaced) / determinant(matrix);
    }
    return scaled;
}

std::array<double, 3> times(const Matrix& matrix, const std::array<double, 3>& from) {
    std::array<double, 3> to{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t col = 0; col < 3; ++col) to[row] += matrix[row][col] * from[col];
    return to;
}

TEST(HdrCurvesTest, ChangesOfPrimariesKeepTheColour) {
    const Matrix bt709 = to_xyz({{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}});
    const Matrix bt2020 = to_xyz({{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}});
    for (const std::array<double, 3>& rgb :
         {std::array{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, 1.0, 1.0}}) {
        std::array<float, 3> light{};
        std::ranges::transform(rgb, light.begin(), [](double v) { return static_cast<float>(v); });
        bt709_to_bt2020(light);
        const auto wanted = times(bt709, rgb);
        const auto found = times(bt2020, std::array<double, 3>{static_cast<double>(light[0]),
                                                               static_cast<double>(light[1]),
                                                               static_cast<double>(light[2])});
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-5);
        bt2020_to_bt709(light);
        for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(light[i], rgb[i], 1e-5);
    }
    std::array<float, 3> green = {0, 1, 0};  // of BT.2020, which BT.709 does not have
    bt2020_to_bt709(green);
    EXPECT_EQ(green[0], 0.0F);
    EXPECT_GT(green[1], 1.0F);
}

}  // namespace
}  // namespace stipple
