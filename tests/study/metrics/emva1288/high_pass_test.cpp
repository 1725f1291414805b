#include "study/metrics/emva1288/high_pass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>

namespace stipple::emva1288 {
namespace {

template <typename Function>
PixelMap map_of(int rows, int cols, const Function& value) {
    PixelMap map{.rows = rows, .cols = cols, .values = {}};
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) map.values.push_back(value(row, col));
    return map;
}

TEST(HighPassTest, KeepsTheVarianceOfWhiteNoise) {
    // Uniform over 0..29: variance 899 / 12. Of n values it scatters by sqrt(0.8 / n) of itself,
    // correlated by the filter by less than 10 % more; 5 of that.
    std::mt19937 random(1);
    const PixelMap map =
        map_of(204, 304, [&](int, int) { return static_cast<double>(random() % 30); });
    EXPECT_NEAR(high_pass_variance(map) / (899.0 / 12), 1, 5 * 1.1 * 0.0037);
}

TEST(HighPassTest, RemovesAPlane) {
    const PixelMap found =
        high_pass(map_of(9, 12, [](int row, int col) { return 100.0 + 3 * row - 2 * col; }));
    EXPECT_EQ(found.rows, 5);
    EXPECT_EQ(found.cols, 8);
    ASSERT_EQ(found.values.size(), 40U);
    for (const double value : found.values) EXPECT_NEAR(value, 0, 1e-12);
}

TEST(HighPassTest, RemovesSlowShading) {
    // cos of a period of 100 pixels along the rows: the window's mean is the cosine times the
    // Dirichlet kernel sin(5 w / 2) / (5 sin(w / 2)), w = 2 pi / 100.
    constexpr double kPi = 3.14159265358979323846;
    constexpr double w = 2 * kPi / 100;
    const PixelMap map =
        map_of(9, 104, [](int, int col) { return 50.0 * std::cos(w * static_cast<double>(col)); });
    const double rest = 1 - std::sin(2.5 * w) / (5 * std::sin(w / 2));
    EXPECT_LT(rest, 0.005);
    // 100 columns are a whole period: mean square 50^2 / 2.
    EXPECT_NEAR(high_pass_variance(map), 1250 * rest * rest / 0.96, 1e-9);
}

TEST(HighPassTest, OfOnePixelIsTheKernel) {
    const PixelMap found =
        high_pass(map_of(9, 9, [](int row, int col) { return row == 4 && col == 4 ? 25.0 : 0.0; }));
    for (std::size_t i = 0; i < found.values.size(); ++i)
        EXPECT_NEAR(found.values[i], i == 12 ? 24 : -1, 1e-12) << i;
}

TEST(HighPassTest, OfASmallMapIsNothing) {
    const PixelMap map = map_of(4, 9, [](int, int) { return 1.0; });
    EXPECT_TRUE(high_pass(map).values.empty());
    EXPECT_TRUE(std::isnan(high_pass_variance(map)));
}

}  // namespace
}  // namespace stipple::emva1288
