#pragma once

#include "readout/schedules/hardware_tiled_grid.h"

namespace stipple {

/// Exchanges codes of groups of one row and class of channels so that neighbours differ, on a tile
/// that repeats in both directions. The loads of whole tiles do not change. Tries at most 4 million
/// exchanges, which take a second or two.
void anneal_frame_potential(GroupTile& tile, const GroupGrid& grid, const CodeSet& codes,
                            Draws& draws);

}  // namespace stipple
