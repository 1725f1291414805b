#include "calibration/shrinkage.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace stipple {
namespace {

constexpr int kSide = 100;

/// A map of kSide x kSide true values plus an error of this variance.
EstimateMap measured(const std::vector<double>& truth, double variance) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    EstimateMap map{.rows = kSide,
                    .cols = kSide,
                    .value = truth,
                    .variance = std::vector<double>(truth.size(), variance)};
    for (double& value : map.value) value += std::sqrt(variance) * normal(random);
    return map;
}

std::vector<double> normal_values(double mean, double deviation) {
    std::mt19937 random(1);
    std::normal_distribution<double> normal(mean, deviation);
    std::vector<double> values(kSide * kSide);
    for (double& value : values) value = normal(random);
    return values;
}

double mean_square(const EstimateMap& map, const std::vector<double>& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < truth.size(); ++i)
        sum += (map.value[i] - truth[i]) * (map.value[i] - truth[i]);
    return sum / static_cast<double>(truth.size());
}

// The variance of 10^4 estimates is known to sqrt(2 / 10^4) = 1.4 %, within 5 of it; so much of the
// noise may be taken for a pattern.
TEST(ShrinkageTest, EqualPixelsBecomeTheirMean) {
    const std::vector<double> truth(kSide * kSide, 64);
    EstimateMap map = measured(truth, 1);
    const PatternVariances pattern = shrink(map);
    EXPECT_NEAR(pattern.mean, 64, 5.0 / kSide);
    EXPECT_LT(pattern.pixels, 0.07);
    EXPECT_EQ(pattern.rows, 0);
    EXPECT_EQ(pattern.cols, 0);
    EXPECT_LT(mean_square(map, truth), 0.01);
}

// The posterior of a normal prior S and a normal error v has the variance S v / (S + v): 0.8 here,
// whose mean over 10^4 pixels scatters by 1.4 %. Within 5 of it.
TEST(ShrinkageTest, ErrorIsThatOfTheReportedVariance) {
    const std::vector<double> truth = normal_values(10, 2);
    EstimateMap map = measured(truth, 1);
    const PatternVariances pattern = shrink(map);
    EXPECT_NEAR(pattern.pixels, 4, 0.07 * 5);
    EXPECT_NEAR(mean_square(map, truth), 0.8, 0.07 * 0.8);
    EXPECT_NEAR(map.variance[17], 0.8, 0.07 * 0.8);
}

TEST(ShrinkageTest, ColumnsAreFoundAndRowsAreNot) {
    std::vector<double> truth(kSide * kSide);
    const std::vector<double> columns = normal_values(0, 0.5);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = columns[i % kSide];
    EstimateMap map = measured(truth, 1);
    const PatternVariances pattern = shrink(map);
    // 100 columns tell their variance of 0.25 to sqrt(2 / 99); within 5 of it.
    EXPECT_NEAR(pattern.cols, 0.25, 0.25 * 5 * std::sqrt(2.0 / 99));
    EXPECT_EQ(pattern.rows, 0);
    // A column's mean has the variance 1 / 100, less than the pixel's own measurement by far.
    EXPECT_LT(mean_square(map, truth), 0.02);
    EXPECT_GE(map.variance[0], 0.009);
}

/// `map` with an error of each row.
EstimateMap with_row_errors(EstimateMap map, const std::vector<double>& error) {
    for (std::size_t i = 0; i < map.value.size(); ++i) map.value[i] += error[i / kSide];
    return map;
}

// Errors of variance 0.25 that a row shares, and pixels of variance 1 in all.
TEST(ShrinkageTest, ErrorsThatARowSharesAreNoPatternOfRows) {
    const std::vector<double> truth(kSide * kSide, 7), errors = normal_values(0, 0.5);
    EstimateMap map = with_row_errors(measured(truth, 0.75), errors);
    std::ranges::fill(map.variance, 1);
    EstimateMap unaware = map;
    EXPECT_NEAR(shrink(unaware).rows, 0.25, 0.25 * 5 * std::sqrt(2.0 / 99));
    map.row_error = 0.25;
    const PatternVariances pattern = shrink(map);
    EXPECT_EQ(pattern.rows, 0);
    EXPECT_LT(pattern.pixels, 0.07);
    EXPECT_EQ(map.row_error, 0);
    EXPECT_LT(mean_square(map, truth), 0.01);
}

// The rows differ by a variance of 4, known to 4 + 0.25: of the latter S v / (S + v) is left.
TEST(ShrinkageTest, APatternOfRowsIsFoundAboveTheErrorsThatRowsShare) {
    std::vector<double> truth(kSide * kSide);
    const std::vector<double> rows = normal_values(0, 2), pixels = normal_values(0, 1);
    for (std::size_t i = 0; i < truth.size(); ++i) truth[i] = rows[i / kSide] + pixels[i];
    std::vector<double> errors = normal_values(0, 0.5);
    std::ranges::reverse(errors);  // other ones than those of the rows
    EstimateMap map = with_row_errors(measured(truth, 0.75), errors);
    std::ranges::fill(map.variance, 1);
    map.row_error = 0.25;
    const PatternVariances pattern = shrink(map);
    EXPECT_NEAR(pattern.rows, 4, 4.25 * 5 * std::sqrt(2.0 / 99));
    EXPECT_NEAR(pattern.pixels, 1, 1.75 * 0.07);
    EXPECT_NEAR(map.row_error, 4 * 0.26 / 4.26, 0.02);
}

TEST(ShrinkageTest, AnOutlierKeepsItsOwnEstimate) {
    const std::vector<double> truth(kSide * kSide, 5);
    EstimateMap map = measured(truth, 1);
    map.value[123] = 900;
    const PatternVariances pattern = shrink(map);
    EXPECT_EQ(map.value[123], 900);
    EXPECT_EQ(map.variance[123], 1);
    EXPECT_EQ(pattern.outliers, 1U);
    EXPECT_NEAR(pattern.mean, 5, 5.0 / kSide);
}

TEST(ShrinkageTest, APixelWithoutMeasurementHasTheMeanAndTheScatterOfTheOthers) {
    EstimateMap map = measured(normal_values(10, 2), 1);
    map.value[4] = -1e9;
    map.variance[4] = std::numeric_limits<double>::infinity();
    const PatternVariances pattern = shrink(map);
    EXPECT_DOUBLE_EQ(map.value[4], pattern.mean);
    EXPECT_DOUBLE_EQ(map.variance[4], pattern.pixels);
}

TEST(ShrinkageTest, ExactEstimatesStay) {
    EstimateMap map = measured(normal_values(10, 2), 0);
    const EstimateMap before = map;
    shrink(map);
    for (std::size_t i = 0; i < map.value.size(); ++i)
        EXPECT_NEAR(map.value[i], before.value[i], 1e-12 * 20);
}

}  // namespace
}  // namespace stipple
