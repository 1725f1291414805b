#include "calibration/robust_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace stipple {
namespace {

constexpr double kDeviationOfMedian = 1.4826;  ///< standard deviation / median abs deviation

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

}  // namespace stipple
