#include "study/metrics/emva1288/deviation_histogram.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <numeric>
#include <random>
#include <vector>

namespace stipple::emva1288 {
namespace {

TEST(DeviationHistogramTest, CountsHotPixelsInTheAccumulatedHistogram) {
    // 10000 pixels of 0 or 1 DN by turns, seven of them at 101 DN: the mean rises by 0.07.
    std::vector<double> values(10000);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i % 2);
    for (std::size_t i = 1; i < 14; i += 2) values[i] = 101;
    const DeviationHistogram found = deviation_histogram(values, 1);
    EXPECT_EQ(found.accumulated_width, 1);
    ASSERT_EQ(found.at_least.size(), 101U);  // to 101 - 0.57
    EXPECT_EQ(found.at_least[0], 10000);
    for (std::size_t q = 1; q < 101; ++q) EXPECT_EQ(found.at_least[q], 7) << q;
    EXPECT_EQ(found.pixels.front(), 5000);
    EXPECT_EQ(found.pixels[1], 4993);
    EXPECT_EQ(found.pixels.back(), 7);
    EXPECT_NEAR(found.first, -0.57, 1e-9);
}

TEST(DeviationHistogramTest, OfNormalValuesIsThatOfTheModel) {
    // Sums of 12 uniform values over 0..99: standard deviation 100. Bins of many pixels scatter by
    // the root of their number; 5 of that.
    std::mt19937 random(1);
    std::vector<double> values(100000);
    for (double& value : values)
        for (int i = 0; i < 12; ++i) value += static_cast<double>(random() % 100);
    const DeviationHistogram found = deviation_histogram(values, 1);
    EXPECT_LE(found.pixels.size(), 256U);
    EXPECT_EQ(std::accumulate(found.pixels.begin(), found.pixels.end(), std::int64_t{0}), 100000);
    for (std::size_t bin = 0; bin < found.pixels.size(); ++bin)
        if (found.normal[bin] > 400) {
            EXPECT_NEAR(static_cast<double>(found.pixels[bin]) / found.normal[bin], 1, 0.25);
        }
}

TEST(DeviationHistogramTest, OfEqualValuesIsOneBin) {
    const DeviationHistogram found = deviation_histogram({3, 3, 3}, 0.5);
    EXPECT_EQ(found.pixels, std::vector<std::int64_t>{3});
    EXPECT_EQ(found.at_least, std::vector<std::int64_t>{3});
    EXPECT_EQ(found.normal, std::vector<double>{3});
    EXPECT_TRUE(deviation_histogram({}, 1).pixels.empty());
}

}  // namespace
}  // namespace stipple::emva1288
