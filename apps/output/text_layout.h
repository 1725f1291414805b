#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <string>

#include "core/text.h"

namespace stipple {

/// Three digits, or so many, more in front of the point, never a power of ten: 0.0123, 1.23, 1234.
[[nodiscard]] inline std::string rounded(double value, int digits = 3) {
    return value >= std::pow(10, digits) - 0.5 ? fmt::format("{:.0f}", value)
                                               : fmt::format("{:.{}g}", value, digits);
}

/// "40 s", "5 min", "2.5 h".
[[nodiscard]] inline std::string rough_time(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60)
                          : fmt::format("{} h", rounded(seconds / 3600, 2));
}

/// The width of a column of a table: of the longest text(row), but not above `max`. Texts that are
/// longer shift the rest of their line.
template <typename Rows, typename Text>
[[nodiscard]] std::size_t column_width(const Rows& rows, Text text,
                                       std::size_t max = std::numeric_limits<std::size_t>::max()) {
    std::size_t width = 0;
    for (const auto& row : rows) width = std::max(width, std::invoke(text, row).size());
    return std::min(width, max);
}

}  // namespace stipple
