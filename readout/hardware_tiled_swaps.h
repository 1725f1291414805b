#pragma once

#include "readout/hardware_tiled_grid.h"

namespace stipple {

/// Exchanges codes of groups of one row and class of channels so that neighbours differ, on a tile
/// that repeats in both directions; no load of whole tiles changes. At most 4 million exchanges are
/// tried, a second or two.
void set_neighbours_apart(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes,
                          Draws& draws);

/// The frame potential of a tile that repeats in both directions: the mean over groups of the sum
/// over neighbours of weight x likeness. Neighbours out of phase have little.
[[nodiscard]] double potential_of(const GroupTile& tile, const GroupGrid& grid,
                                  const CodeSet& codes);

}  // namespace stipple
