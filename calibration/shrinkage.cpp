#include "calibration/shrinkage.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/index.h"

namespace stipple {
namespace {

constexpr double kDeviationOfMedian = 1.4826;  ///< standard deviation / median abs deviation

constexpr double kOutlierSigmas = 6;
constexpr double kLineSigmas = 3;
constexpr int kMinLines = 8;  ///< fewer do not tell their variance

/// Mean residual of each line, and how much of its variance is that of the quantity.
struct Lines {
    std::vector<double> mean;
    double variance = 0;        ///< of the quantity; 0: not significant
    double error_variance = 0;  ///< of a mean, by the scatter within its line and what it shares
};

/// `line_of(i)` is the line of pixel i, `shared` the variance of the errors that its pixels share.
template <typename LineOf>
Lines lines_of(const std::vector<double>& residual, const std::vector<bool>& used, int count,
               const LineOf& line_of, double shared = 0) {
    Lines lines{.mean = std::vector<double>(index(count))};
    std::vector<double> pixels(index(count)), squares(index(count));
    for (std::size_t i = 0; i < residual.size(); ++i) {
        if (!used[i]) continue;
        const std::size_t line = line_of(i);
        ++pixels[line];
        lines.mean[line] += residual[i];
        squares[line] += residual[i] * residual[i];
    }
    double measured = 0, between = 0, error = 0;
    for (std::size_t line = 0; line < pixels.size(); ++line) {
        const double n = pixels[line];
        lines.mean[line] = n > 0 ? lines.mean[line] / n : 0;
        if (n < 2) continue;
        ++measured;
        between += lines.mean[line] * lines.mean[line];
        error += std::max(squares[line] / n - lines.mean[line] * lines.mean[line], 0.0) / (n - 1);
    }
    if (measured < kMinLines) return lines;
    between /= measured - 1;
    lines.error_variance = error / measured + shared;
    const double excess = between - lines.error_variance;
    if (excess > kLineSigmas * lines.error_variance * std::sqrt(2 / (measured - 1)))
        lines.variance = excess;
    return lines;
}

/// Takes the lines out of the residuals. Returns the variance of what is taken.
template <typename LineOf>
double remove_lines(const Lines& lines, const LineOf& line_of, std::vector<double>& residual,
                    std::vector<double>& value) {
    if (lines.variance == 0) return 0;
    const double weight = lines.variance / (lines.variance + lines.error_variance);
    for (std::size_t i = 0; i < residual.size(); ++i) {
        const double line = weight * lines.mean[line_of(i)];
        residual[i] -= line;
        value[i] += line;
    }
    return weight * lines.error_variance;
}

}  // namespace

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

double robust_deviation(std::vector<double> deviations) {
    for (double& deviation : deviations) deviation = std::abs(deviation);
    return kDeviationOfMedian * median(std::move(deviations));
}

std::vector<bool> inliers(const EstimateMap& map) {
    std::vector<bool> used(map.value.size(), false);
    std::vector<double> measured;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (std::isfinite(map.variance[i])) measured.push_back(map.value[i]);
    if (measured.empty()) return used;
    const double centre = median(measured);
    for (double& value : measured) value -= centre;
    const double deviation = robust_deviation(std::move(measured));
    for (std::size_t i = 0; i < used.size(); ++i) {
        // Where most pixels are exactly equal, their own error still is.
        const double sigma = std::max(deviation, std::sqrt(map.variance[i]));
        used[i] = std::isfinite(map.variance[i]) &&
                  std::abs(map.value[i] - centre) <= kOutlierSigmas * sigma;
    }
    return used;
}

double mean_of(const std::vector<double>& values, const std::vector<bool>& used) {
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (used[i]) {
            sum += values[i];
            ++count;
        }
    return count > 0 ? sum / count : 0;
}

PatternVariances shrink(EstimateMap& map) {
    const std::vector<bool> used = inliers(map);
    const auto cols = index(map.cols);
    PatternVariances pattern{.mean = mean_of(map.value, used)};
    std::vector<double> residual(map.value.size()), value(map.value.size(), pattern.mean);
    for (std::size_t i = 0; i < residual.size(); ++i)
        residual[i] = used[i] ? map.value[i] - pattern.mean : 0;
    const auto col_of = [cols](std::size_t i) { return i % cols; };
    const auto row_of = [cols](std::size_t i) { return i / cols; };
    const Lines columns = lines_of(residual, used, map.cols, col_of);
    double line_error = remove_lines(columns, col_of, residual, value);
    const Lines rows = lines_of(residual, used, map.rows, row_of, map.row_error);
    const double removed_error = rows.variance > 0 ? map.row_error : 0;
    map.row_error = remove_lines(rows, row_of, residual, value);
    line_error += map.row_error;
    pattern.cols = columns.variance;
    pattern.rows = rows.variance;
    std::vector<double> squares(residual.size());
    std::ranges::transform(residual, squares.begin(), [](double r) { return r * r; });
    pattern.pixels =
        std::max(mean_of(squares, used) - mean_of(map.variance, used) + removed_error, 0.0);
    for (std::size_t i = 0; i < value.size(); ++i) {
        const double v = map.variance[i];
        if (!used[i]) {
            if (std::isfinite(v)) {
                ++pattern.outliers;
                continue;
            }
            map.value[i] = value[i];
            map.variance[i] = pattern.pixels + line_error;
            continue;
        }
        const double weight = pattern.pixels > 0 ? pattern.pixels / (pattern.pixels + v) : 0;
        map.value[i] = value[i] + weight * residual[i];
        map.variance[i] = weight * v + (1 - weight) * (1 - weight) * line_error;
    }
    return pattern;
}

}  // namespace stipple
