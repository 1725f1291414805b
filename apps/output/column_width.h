#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>

namespace stipple {

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
