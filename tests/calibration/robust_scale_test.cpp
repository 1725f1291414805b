#include "calibration/shrinkage.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace stipple {
namespace {

TEST(RobustScaleTest, TheMedianIsTheMiddleValue) {
    EXPECT_EQ(median({5}), 5);
    EXPECT_EQ(median({9, -1, 4}), 4);
    EXPECT_EQ(median({9, -1, 4, 7}), 7);
}

TEST(RobustScaleTest, OutliersHardlyChangeTheDeviation) {
    std::mt19937_64 generator(1);
    std::normal_distribution<double> normal(0, 3);
    std::vector<double> deviations(20000);
    for (double& deviation : deviations) deviation = normal(generator);
    for (std::size_t i = 0; i < deviations.size(); i += 100) deviations[i] = 1e6;
    EXPECT_NEAR(robust_deviation(deviations), 3, 0.1);
}

}  // namespace
}  // namespace stipple
