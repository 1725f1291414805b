#include "io/primaries.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace stipple {
namespace {

constexpr Primaries kXyz{{1, 0}, {0, 1}, {0, 0}, {1.0 / 3, 1.0 / 3}};
constexpr Primaries kAces{{0.7347, 0.2653}, {0.0, 1.0}, {0.0001, -0.0770}, {0.32168, 0.33767}};

void expect_near(const ColourMatrix& matrix, const ColourMatrix& expected, double tolerance) {
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t col = 0; col < 3; ++col)
            EXPECT_NEAR(matrix[row][col], expected[row][col], tolerance) << row << ' ' << col;
}

TEST(PrimariesTest, HasThePublishedMatrices) {
    // IEC 61966-2-1: from XYZ to linear sRGB, to four digits.
    expect_near(
        *to_rec709(kXyz),
        {{{3.2406, -1.5372, -0.4986}, {-0.9689, 1.8758, 0.0415}, {0.0557, -0.2040, 1.0570}}}, 5e-4);
    // ITU-R BT.2087: from BT.2020, which has the same white.
    expect_near(
        *to_rec709({{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}, {0.3127, 0.3290}}),
        {{{1.6605, -0.5876, -0.0728}, {-0.1246, 1.1329, -0.0083}, {-0.0182, -0.1006, 1.1187}}},
        5e-5);
    // OpenColorIO's matrix from ACES 2065-1, by Bradford, to four digits.
    expect_near(
        *to_rec709(kAces),
        {{{2.5217, -1.1341, -0.3876}, {-0.2765, 1.3727, -0.0962}, {-0.0154, -0.1530, 1.1684}}},
        5e-4);
    EXPECT_TRUE(is_identity(*to_rec709({})));
    EXPECT_FALSE(is_identity(*to_rec709(kXyz)));
}

/// White stays white where it is adapted, and no white is that of X = Y = Z.
TEST(PrimariesTest, AdaptsTheWhite) {
    const ColourMatrix matrix = *to_rec709(kAces);
    for (const auto& row : matrix) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-12);
    const ColourMatrix of_xyz = *to_rec709(kXyz);
    EXPECT_NEAR(of_xyz[0][0] + of_xyz[0][1] + of_xyz[0][2], 1.2048, 5e-4);
}

TEST(PrimariesTest, HasNoneOfPrimariesThatMakeNoColours) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const Primaries& none : {Primaries{{0.3, 0.3}, {0.3, 0.3}, {0.1, 0.1}, {0.3, 0.3}},
                                  Primaries{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}, {0.3, 0.3}},
                                  Primaries{{nan, 0}}, Primaries{.white = {0.3, 0}},
                                  Primaries{.white = {0.3, -1}}, Primaries{.white = {nan, nan}},
                                  Primaries{.red = {std::numeric_limits<double>::infinity(), 0}}})
        EXPECT_FALSE(to_rec709(none).has_value());
}

TEST(PrimariesTest, KeepsTheLuminanceOfColoursOutside) {
    const ColourMatrix matrix = *to_rec709(kXyz);
    // Spectral green (520 nm), a purple, and grey: X, Y, Z a plane each.
    std::vector<float> planes{0.0633F, 0.4F, 0.95F, 0.71F, 0.2F, 1.0F, 0.0782F, 0.9F, 1.09F};
    const std::vector<float> xyz = planes;
    convert(planes, matrix);
    for (std::size_t i = 0; i < 3; ++i) {
        const float luminance =
            0.2126F * planes[i] + 0.7152F * planes[3 + i] + 0.0722F * planes[6 + i];
        EXPECT_NEAR(luminance, xyz[3 + i], 2e-4);
        for (std::size_t plane = 0; plane < 3; ++plane) EXPECT_GE(planes[3 * plane + i], 0);
    }
    std::vector<float> negative{-0.1F, 0.5F, 0.5F};
    convert(negative, matrix);
    EXPECT_LT(negative[0], -1);
    std::vector<float> nan(3, std::numeric_limits<float>::quiet_NaN());
    convert(nan, matrix);
    EXPECT_TRUE(std::isnan(nan[0]));
}

}  // namespace
}  // namespace stipple
