#include "study/metrics/emva1288/high_pass.h"

#include <cstddef>
#include <limits>

namespace stipple::emva1288 {
namespace {

constexpr double kWindow = kHighPassSize * kHighPassSize;

double window_mean(const PixelMap& map, int row, int col) {
    double sum = 0;
    for (int r = row; r < row + kHighPassSize; ++r)
        for (int c = col; c < col + kHighPassSize; ++c)
            sum += map.values[static_cast<std::size_t>(r) * static_cast<std::size_t>(map.cols) +
                              static_cast<std::size_t>(c)];
    return sum / kWindow;
}

}  // namespace

PixelMap high_pass(const PixelMap& map) {
    constexpr int kHalf = kHighPassSize / 2;
    if (map.rows < kHighPassSize || map.cols < kHighPassSize) return {};
    PixelMap filtered{.rows = map.rows - 2 * kHalf, .cols = map.cols - 2 * kHalf, .values = {}};
    for (int row = 0; row < filtered.rows; ++row) {
        const std::size_t centre =
            static_cast<std::size_t>(row + kHalf) * static_cast<std::size_t>(map.cols) + kHalf;
        for (int col = 0; col < filtered.cols; ++col)
            filtered.values.push_back(map.values[centre + static_cast<std::size_t>(col)] -
                                      window_mean(map, row, col));
    }
    return filtered;
}

double high_pass_variance(const PixelMap& map) {
    const std::vector<double> values = high_pass(map).values;
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    const auto count = static_cast<double>(values.size());
    double mean = 0, sum = 0;
    for (const double value : values) mean += value / count;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum / count / (1 - 1 / kWindow);
}

}  // namespace stipple::emva1288
