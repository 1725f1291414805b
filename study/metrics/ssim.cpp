#include "study/metrics/perceptual.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "core/parallel.h"

namespace stipple {
namespace {

constexpr int kRadius = 5;
constexpr int kWindow = 2 * kRadius + 1;
using Weights = std::array<double, kWindow>;

Weights gaussian_weights() {
    constexpr double kSigma = 1.5;
    Weights weights;
    for (int i = 0; i < kWindow; ++i) {
        const double distance = i - kRadius;
        weights[static_cast<std::size_t>(i)] =
            std::exp(-distance * distance / (2 * kSigma * kSigma));
    }
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights) weight /= sum;
    return weights;
}

/// Weighted sums over a window.
struct Moments {
    double x = 0;
    double y = 0;
    double xx = 0;
    double yy = 0;
    double xy = 0;

    void add(double weight, const Moments& m) {
        x += weight * m.x;
        y += weight * m.y;
        xx += weight * m.xx;
        yy += weight * m.yy;
        xy += weight * m.xy;
    }
};

double similarity(const Moments& m) {
    constexpr double kC1 = 0.01 * 0.01;
    constexpr double kC2 = 0.03 * 0.03;
    const double variances = m.xx - m.x * m.x + m.yy - m.y * m.y;
    const double covariance = m.xy - m.x * m.y;
    return (2 * m.x * m.y + kC1) * (2 * covariance + kC2) /
           ((m.x * m.x + m.y * m.y + kC1) * (variances + kC2));
}

/// Moments of each column in rows [row, row + kWindow).
std::vector<Moments> column_moments(PlaneView<const float> x, PlaneView<const float> y, int row,
                                    const Weights& weights) {
    std::vector<Moments> columns(static_cast<std::size_t>(x.cols()));
    for (int k = 0; k < kWindow; ++k) {
        const auto x_row = x.row(row + k);
        const auto y_row = y.row(row + k);
        for (std::size_t col = 0; col < columns.size(); ++col) {
            const double a = static_cast<double>(x_row[col]);
            const double b = static_cast<double>(y_row[col]);
            columns[col].add(weights[static_cast<std::size_t>(k)], {a, b, a * a, b * b, a * b});
        }
    }
    return columns;
}

/// Sum of the similarities of all windows that begin in `row`.
double row_sum(PlaneView<const float> x, PlaneView<const float> y, int row,
               const Weights& weights) {
    const auto columns = column_moments(x, y, row, weights);
    double sum = 0;
    for (std::size_t col = 0; col + kWindow <= columns.size(); ++col) {
        Moments window;
        for (std::size_t k = 0; k < kWindow; ++k) window.add(weights[k], columns[col + k]);
        sum += similarity(window);
    }
    return sum;
}

}  // namespace

double ssim(PlaneView<const float> x, PlaneView<const float> y) {
    const int rows = x.rows() - kWindow + 1;
    const int cols = x.cols() - kWindow + 1;
    if (rows < 1 || cols < 1) return std::numeric_limits<double>::quiet_NaN();
    static const Weights kWeights = gaussian_weights();
    std::vector<double> sums(static_cast<std::size_t>(rows));
    parallel_for(0, rows, [&](int row) {
        sums[static_cast<std::size_t>(row)] = row_sum(x, y, row, kWeights);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0) / (static_cast<double>(rows) * cols);
}

}  // namespace stipple
