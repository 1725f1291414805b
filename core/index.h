#pragma once

#include <cstddef>
#include <cstdint>

namespace stipple {

// Unchecked: assertions stay in the optimised build, and inner loops use these.

/// A signed coordinate (row, column, plane, slot) as an index of a container. Precondition:
/// value >= 0.
[[nodiscard]] constexpr std::size_t index(std::int64_t value) {
    return static_cast<std::size_t>(value);
}

/// Index of the element (row, col) of an array of rows of `cols` elements: row-major order, rows
/// packed without gaps. Precondition: row >= 0, 0 <= col < cols.
[[nodiscard]] constexpr std::size_t row_major(int row, int col, int cols) {
    return index(row) * index(cols) + index(col);
}

}  // namespace stipple
