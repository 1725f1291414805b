#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>

namespace stipple {

/// A signed coordinate (row, column, plane, slot) as an index of a container. Precondition:
/// value >= 0.
[[nodiscard]] constexpr std::size_t index(std::int64_t value) {
    assert(value >= 0);
    return static_cast<std::size_t>(value);
}

/// Index of the element (row, col) of an array of rows of `cols` elements: row-major order, rows
/// packed without gaps. Precondition: row >= 0, 0 <= col < cols.
[[nodiscard]] constexpr std::size_t row_major(int row, int col, int cols) {
    assert(col >= 0 && col < cols);
    return index(row) * index(cols) + index(col);
}

}  // namespace stipple
