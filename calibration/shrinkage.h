#pragma once

#include <cstddef>
#include <vector>

namespace stipple {

/// Estimates of one quantity at the pixels of a plane, order (row, col).
struct EstimateMap {
    int rows = 0;
    int cols = 0;
    std::vector<double> value;
    std::vector<double> variance;  ///< of the estimate; infinite where nothing was measured
    double row_error = 0;  ///< part of the variance: of errors that the pixels of a row share
};

/// What makes the pixels of a map differ: variances of the quantity itself, without those of its
/// measurement.
struct PatternVariances {
    double mean = 0;
    double rows = 0;           ///< between rows; 0: not significant
    double cols = 0;           ///< between columns; 0: not significant
    double pixels = 0;         ///< within rows and columns
    std::size_t outliers = 0;  ///< pixels of another population
};

/// Replaces the estimates by their posterior means and variances (empirical Bayes; Efron and
/// Morris 1973, of which this is the form for a model with rows and columns):
///
///     value = mean + row + col + w (estimate - mean - row - col),   w = S / (S + v)
///
/// v is the variance of the estimate and S the variance of the pixels: that of the estimates minus
/// the mean v, at least 0. Rows and columns are shrunk likewise, by the variance that the mean of a
/// line has, in which `row_error` counts whole; they are 0 unless they differ by more than three
/// standard deviations of what pixels without lines give. Outliers, more than six standard
/// deviations (1.4826 x median absolute deviation) from the median, keep their own estimates.
PatternVariances shrink(EstimateMap& map);

/// The pixels of which `shrink` takes the means: measured, and no outliers.
[[nodiscard]] std::vector<bool> inliers(const EstimateMap& map);

/// Mean of the values that are used; 0 if there is none.
[[nodiscard]] double mean_of(const std::vector<double>& values, const std::vector<bool>& used);

/// The middle value, of an even number the upper one. Precondition: there is a value.
[[nodiscard]] double median(std::vector<double> values);

/// The standard deviation of normal deviations that have some outliers: 1.4826 times the median of
/// their magnitudes. Precondition: there is a deviation.
[[nodiscard]] double robust_deviation(std::vector<double> deviations);

}  // namespace stipple
