#include "io/footage_part.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>
#include <vector>

namespace stipple {
namespace {

using Floats = std::vector<float>;

Floats averaged(const Floats& from, int rows, int cols, int to_rows, int to_cols) {
    Floats to(static_cast<std::size_t>(to_rows) * static_cast<std::size_t>(to_cols));
    average_areas({from.data(), rows, cols}, {to.data(), to_rows, to_cols});
    return to;
}

TEST(AreaAverageTest, BinningARampGivesItsMiddles) {
    // Light 10 row + col; the mean of 2 x 2 pixels is 10 (2 r + 1/2) + 2 c + 1/2.
    Floats ramp;
    for (int row = 0; row < 4; ++row)
        for (int col = 0; col < 6; ++col) ramp.push_back(static_cast<float>(10 * row + col));
    EXPECT_EQ(averaged(ramp, 4, 6, 2, 3), (Floats{5.5, 7.5, 9.5, 25.5, 27.5, 29.5}));
}

TEST(AreaAverageTest, PixelsAtTheBordersCountByTheirShare) {
    // 3 pixels in 2: the middle one is shared.
    EXPECT_EQ(averaged({6, 3, 12}, 1, 3, 1, 2), (Floats{(2 * 6 + 3) / 3.0F, (3 + 2 * 12) / 3.0F}));
    EXPECT_EQ(averaged({6, 3, 12}, 3, 1, 2, 1), (Floats{5, 9}));
    // 5 in 2: 2.5 pixels each.
    EXPECT_EQ(averaged({1, 2, 3, 4, 5}, 1, 5, 1, 2), (Floats{4.5F / 2.5F, 10.5F / 2.5F}));
}

TEST(AreaAverageTest, KeepsTheMeanAndIsNeverNegative) {
    Floats light(std::size_t{7} * 11);
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = i % 5 == 0 ? 100.0F : 0.0F;
    const auto mean = [](const Floats& values) {
        return std::accumulate(values.begin(), values.end(), 0.0) /
               static_cast<double>(values.size());
    };
    for (const auto& [rows, cols] : {std::pair(3, 4), {7, 11}, {1, 1}, {6, 10}}) {
        const Floats to = averaged(light, 7, 11, rows, cols);
        EXPECT_NEAR(mean(to), mean(light), 1e-5) << rows << " x " << cols;  // rounding to float
        for (const float value : to) EXPECT_GE(value, 0);
    }
    EXPECT_EQ(averaged(light, 7, 11, 7, 11), light);
}

}  // namespace
}  // namespace stipple
