#include "decoder/best/colour_axes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr std::size_t kColours = 3;

double product(const ColourMatrix& a, std::size_t col_a, const ColourMatrix& b, std::size_t col_b) {
    double sum = 0;
    for (std::size_t row = 0; row < kColours; ++row)
        sum += static_cast<double>(a[row][col_a]) * static_cast<double>(b[row][col_b]);
    return sum;
}

/// C axes, whose columns are multiples of those of `axes` if these are eigenvectors.
ColourMatrix image(const ColourMatrix& covariance, const ColourMatrix& axes) {
    ColourMatrix result = {};
    for (std::size_t i = 0; i < kColours; ++i)
        for (std::size_t j = 0; j < kColours; ++j)
            for (std::size_t k = 0; k < kColours; ++k)
                result[i][j] += covariance[i][k] * axes[k][j];
    return result;
}

void expect_axes(const ColourMatrix& covariance) {
    const ColourMatrix axes = principal_colour_axes(covariance);
    const ColourMatrix turned = image(covariance, axes);
    const double trace =
        static_cast<double>(covariance[0][0] + covariance[1][1] + covariance[2][2]);
    for (std::size_t i = 0; i < kColours; ++i)
        for (std::size_t j = 0; j < kColours; ++j) {
            // Some 60 operations in float.
            EXPECT_NEAR(product(axes, i, axes, j), i == j ? 1 : 0, 4e-6);
            if (i != j) {
                EXPECT_NEAR(product(axes, i, turned, j), 0, 4e-6 * trace);
            }
        }
}

TEST(ColourAxesTest, AreOrthonormalAndMakeTheCovarianceDiagonal) {
    for (std::uint32_t seed = 1; seed <= 200; ++seed) {
        const std::vector<float> x = random_values(12, -1, 1, seed);
        ColourMatrix covariance = {};
        const std::size_t vectors = seed % 4 + 1;  // fewer than three: some variances are 0
        for (std::size_t i = 0; i < kColours; ++i)
            for (std::size_t j = 0; j < kColours; ++j)
                for (std::size_t k = 0; k < vectors; ++k)
                    covariance[i][j] += x[3 * k + i] * x[3 * k + j];
        SCOPED_TRACE(seed);
        expect_axes(covariance);
    }
}

TEST(ColourAxesTest, HoldForColoursOfEqualOrNoOrVeryUnequalVariance) {
    expect_axes({});
    expect_axes({{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
    expect_axes({{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}});
    expect_axes({{{1e6F, 1e-6F, 0}, {1e-6F, 1e-6F, 1e-20F}, {0, 1e-20F, 1e-30F}}});
}

TEST(ColourAxesTest, OneIsTheColourThatAloneVaries) {
    const float red = 0.8F;
    const float green = 0.6F;
    const ColourMatrix axes = principal_colour_axes(
        {{{red * red, red * green, 0}, {red * green, green * green, 0}, {0, 0, 0}}});
    double most = 0;
    for (std::size_t i = 0; i < kColours; ++i)
        most = std::max(most, static_cast<double>(std::abs(red * axes[0][i] + green * axes[1][i])));
    EXPECT_NEAR(most, 1, 1e-6);
}

}  // namespace
}  // namespace stipple
