#include "study/metrics/perceptual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/noise.h"

namespace stipple {
namespace {

using Floats = std::vector<float>;

/// The definition, window by window with a two-dimensional Gaussian.
double slow_ssim(const Floats& x, const Floats& y, int rows, int cols) {
    double total_weight = 0;
    const auto weight = [](int i, int j) { return std::exp(-(i * i + j * j) / (2 * 1.5 * 1.5)); };
    for (int i = -5; i <= 5; ++i)
        for (int j = -5; j <= 5; ++j) total_weight += weight(i, j);
    double sum = 0;
    for (int row = 5; row < rows - 5; ++row)
        for (int col = 5; col < cols - 5; ++col) {
            const auto mean = [&](auto value) {
                double m = 0;
                for (int i = -5; i <= 5; ++i)
                    for (int j = -5; j <= 5; ++j) {
                        const auto at = static_cast<std::size_t>((row + i) * cols + col + j);
                        m += weight(i, j) / total_weight *
                             value(static_cast<double>(x[at]), static_cast<double>(y[at]));
                    }
                return m;
            };
            const double mx = mean([](double a, double) { return a; });
            const double my = mean([](double, double b) { return b; });
            const double vx = mean([&](double a, double) { return (a - mx) * (a - mx); });
            const double vy = mean([&](double, double b) { return (b - my) * (b - my); });
            const double cxy = mean([&](double a, double b) { return (a - mx) * (b - my); });
            sum += (2 * mx * my + 1e-4) * (2 * cxy + 9e-4) /
                   ((mx * mx + my * my + 1e-4) * (vx + vy + 9e-4));
        }
    return sum / ((rows - 10) * (cols - 10));
}

TEST(SsimTest, OfAPlaneWithItselfIsOne) {
    const Floats x = noise(20 * 30, 1);
    EXPECT_NEAR(ssim({x.data(), 20, 30}, {x.data(), 20, 30}), 1, 1e-12);
}

TEST(SsimTest, OfFlatPlanesIsTheLuminanceTerm) {
    const Floats x(12 * 15, 0.25F);
    const Floats y(12 * 15, 0.75F);
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    // 0.25 and 0.75 are exact, so the variances are zero but for rounding of double sums.
    EXPECT_NEAR(ssim({x.data(), 12, 15}, {y.data(), 12, 15}), expected, 1e-12);
}

TEST(SsimTest, AgreesWithTheDefinition) {
    const int rows = 17;
    const int cols = 23;
    const Floats x = noise(rows * cols, 2);
    Floats y = noise(rows * cols, 3);
    for (std::size_t i = 0; i < y.size(); ++i) y[i] = 0.6F * x[i] + 0.4F * y[i];
    // Both forms compute in double; E[x^2] - E[x]^2 loses about 1e-16 / 9e-4 per window.
    EXPECT_NEAR(ssim({x.data(), rows, cols}, {y.data(), rows, cols}), slow_ssim(x, y, rows, cols),
                1e-11);
}

TEST(SsimTest, IsUndefinedForPlanesSmallerThanTheWindow) {
    const Floats x(11 * 11, 0.5F);
    EXPECT_NEAR(ssim({x.data(), 11, 11}, {x.data(), 11, 11}), 1, 1e-12);
    EXPECT_TRUE(std::isnan(ssim({x.data(), 10, 11}, {x.data(), 10, 11})));
    EXPECT_TRUE(std::isnan(ssim({x.data(), 11, 10}, {x.data(), 11, 10})));
}

}  // namespace
}  // namespace stipple
