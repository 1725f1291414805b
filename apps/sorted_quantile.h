#pragma once

#include <cstddef>
#include <span>

namespace stipple {

/// The value that `share` (0..1) of the others do not exceed. Precondition: sorted, not empty.
[[nodiscard]] inline double sorted_quantile(std::span<const float> values, double share) {
    const auto last = static_cast<double>(values.size() - 1);
    return static_cast<double>(values[static_cast<std::size_t>(share * last + 0.5)]);
}

}  // namespace stipple
