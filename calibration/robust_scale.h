#pragma once

#include <vector>

namespace stipple {

/// The middle value, of an even number the upper one. Precondition: there is a value.
[[nodiscard]] double median(std::vector<double> values);

/// The standard deviation of normal deviations that have some outliers: 1.4826 times the median of
/// their magnitudes. Precondition: there is a deviation.
[[nodiscard]] double robust_deviation(std::vector<double> deviations);

}  // namespace stipple
