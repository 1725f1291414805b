#pragma once

#include <optional>

#include "readout/schedules/hardware_tiled_grid.h"

namespace stipple {

/// A tile in which the group (row, col) begins its code in the slot
///     per_row * row + per_col * col + per_period * floor(col / period)    (mod period),
/// all in one order of the lengths. The numbers minimise the frame potential (CodeSet::overlap of
/// neighbours) among those that balance the channels. Where the channels
/// and the period have no common factor, `per_period` is 0 and the tile is period x period.
/// `rows` and `cols` are sizes in groups, 0: the smallest. Nothing if a size is not a multiple of
/// the period.
[[nodiscard]] std::optional<GroupTile> lattice_tile(const GroupGrid& grid, const CodeSet& codes,
                                                    int rows, int cols, Draws& draws);

}  // namespace stipple
