#include "decoder/best/patch_kernels.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>

#include "tests/decoder/recordings.h"

namespace stipple {
namespace {

constexpr std::size_t kColours = 3;

Eigen::Matrix3d matrix(const ColourMatrix& rows) {
    return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(rows[0].data())
        .cast<double>();
}

void expect_axes(const ColourMatrix& covariance) {
    const Eigen::Matrix3d axes = matrix(principal_colour_axes(covariance));
    const Eigen::Matrix3d product = axes.transpose() * axes;
    const Eigen::Matrix3d turned = axes.transpose() * matrix(covariance) * axes;
    // Some 60 operations in float.
    constexpr double kRounding = 4e-6;
    EXPECT_LE((product - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), kRounding);
    const double rounding = kRounding * turned.trace();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < i; ++j) {
            EXPECT_NEAR(turned(i, j), 0, rounding);
            EXPECT_LE(turned(j, j), turned(i, i) + rounding) << "by growing variance";
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

TEST(ColourAxesTest, TheLastIsTheColourThatAloneVaries) {
    const float red = 0.8F;
    const float green = 0.6F;
    const ColourMatrix axes = principal_colour_axes(
        {{{red * red, red * green, 0}, {red * green, green * green, 0}, {0, 0, 0}}});
    EXPECT_NEAR(std::abs(red * axes[0][2] + green * axes[1][2]), 1, 1e-6);
}

}  // namespace
}  // namespace stipple
