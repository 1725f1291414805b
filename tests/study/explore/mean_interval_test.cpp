#include "study/explore/ranking.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace stipple {
namespace {

TEST(MeanIntervalTest, StudentsTIsThatOfTheTables) {
    // Abramowitz and Stegun, table 26.10, and the closed forms of one and two degrees.
    EXPECT_NEAR(student_t_975(1), std::tan(0.475 * std::numbers::pi), 1e-9);
    EXPECT_NEAR(student_t_975(2), 0.95 / std::sqrt(2 * 0.975 * 0.025), 1e-12);
    EXPECT_NEAR(student_t_975(3), 3.182, 5e-4);
    EXPECT_NEAR(student_t_975(4), 2.776, 5e-4);
    EXPECT_NEAR(student_t_975(9), 2.262, 5e-4);
    EXPECT_NEAR(student_t_975(30), 2.042, 5e-4);
    EXPECT_NEAR(student_t_975(120), 1.980, 5e-4);
}

TEST(MeanIntervalTest, IsTheMeanAndTTimesItsStandardError) {
    const MeanInterval interval = mean_interval(std::vector{1.0, 2.0, 3.0});
    EXPECT_EQ(interval.mean, 2);
    const double half = student_t_975(2) / std::sqrt(3.0);  // the samples deviate by 1
    EXPECT_NEAR(interval.low, 2 - half, 1e-12);
    EXPECT_NEAR(interval.high, 2 + half, 1e-12);
    EXPECT_TRUE(interval.may_be_zero());
    EXPECT_FALSE(mean_interval(std::vector{-5.0, -5.1, -4.9}).may_be_zero());
}

TEST(MeanIntervalTest, EqualSamplesAreTheirInterval) {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const double value : {0.1, -0.3, infinite}) {
        const MeanInterval interval = mean_interval(std::vector(3, value));
        EXPECT_EQ(interval.mean, value);
        EXPECT_EQ(interval.low, value);
        EXPECT_EQ(interval.high, value);
    }
}

TEST(MeanIntervalTest, OneSampleAndInfiniteOnesHaveNone) {
    const double infinite = std::numeric_limits<double>::infinity();
    for (const std::vector<double>& samples :
         {std::vector{5.0}, {5.0, infinite}, {5.0, std::nan("")}}) {
        const MeanInterval interval = mean_interval(samples);
        EXPECT_TRUE(std::isnan(interval.low) && std::isnan(interval.high));
        EXPECT_TRUE(interval.may_be_zero());
    }
    EXPECT_EQ(mean_interval(std::vector{5.0}).mean, 5);
}

TEST(MeanIntervalTest, HoldsTheMeanOfNormalSamplesAsOftenAsItSays) {
    // 8000 runs: the standard error of the share is 0.24 %, so 1 % is four of it.
    constexpr int kRuns = 8000;
    for (const int count : {2, 3, 5, 10, 30}) {
        std::mt19937 random(static_cast<unsigned>(count));
        std::normal_distribution<double> normal(30, 0.7);
        int held = 0;
        for (int run = 0; run < kRuns; ++run) {
            std::vector<double> samples(static_cast<std::size_t>(count));
            for (double& sample : samples) sample = normal(random);
            const MeanInterval interval = mean_interval(samples);
            held += interval.low <= 30 && 30 <= interval.high ? 1 : 0;
        }
        EXPECT_NEAR(static_cast<double>(held) / kRuns, 0.95, 0.01) << count << " samples";
    }
}

}  // namespace
}  // namespace stipple
