#pragma once

#include "readout/schedules/hardware_tiled_grid.h"

namespace stipple {

/// Exchanges codes of groups of one row and class of channels so that neighbours differ, on a tile
/// that repeats in both directions; no load of whole tiles changes. At most 4 million exchanges are
/// tried, a second or two.
void anneal_frame_potential(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes,
                            Draws& draws);

}  // namespace stipple
