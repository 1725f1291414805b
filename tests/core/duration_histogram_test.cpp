#include "core/duration_histogram.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace stipple {
namespace {

TEST(DurationHistogramTest, QuantilesAreWithinSixTenthsOfAPercent) {
    std::mt19937 random(1);
    std::lognormal_distribution<double> durations(std::log(300.0), 3);
    DurationHistogram histogram;
    std::vector<double> sorted(5001);
    for (double& duration_us : sorted) histogram.add(duration_us = durations(random));
    std::ranges::sort(sorted);
    for (const double share : {0.0, 0.01, 0.5, 0.9, 0.99})
        EXPECT_NEAR(
            histogram.quantile_us(share) / sorted[static_cast<std::size_t>(share * 5000 + 0.5)], 1,
            0.006)
            << share;
    EXPECT_EQ(histogram.quantile_us(1), sorted.back());
    EXPECT_EQ(histogram.longest_us(), sorted.back());
    EXPECT_EQ(histogram.count(), 5001U);
}

TEST(DurationHistogramTest, NothingAndNegativeDurationsCountAsTheShortest) {
    DurationHistogram histogram;
    for (const double duration_us : {-5.0, 0.0, 1000.0}) histogram.add(duration_us);
    EXPECT_LT(histogram.quantile_us(0.5), 0.001);
    EXPECT_EQ(histogram.quantile_us(1), 1000);
}

TEST(DurationHistogramTest, OneDurationIsAllQuantiles) {
    DurationHistogram histogram;
    histogram.add(42);
    EXPECT_EQ(histogram.quantile_us(0), 42);
    EXPECT_EQ(histogram.quantile_us(0.5), 42);
}

TEST(DurationHistogramTest, TheLongestDurationsShareABin) {
    DurationHistogram histogram;
    for (int i = 0; i < 3; ++i) histogram.add(1e18);
    EXPECT_EQ(histogram.longest_us(), 1e18);
    EXPECT_GE(histogram.quantile_us(0.5), 1e12);
}

}  // namespace
}  // namespace stipple
