#pragma once

#include "readout/schedules/hardware_tiled_grid.h"

namespace stipple {

/// A tile of any size. First every row gets, for each class of channels, codes that together are
/// due as evenly over the slots as can be: whole sets, one order from every slot of the period, and
/// for what is left the best that a search finds, the same load in all channels. Then groups of one
/// row and class change places: that keeps the loads, and moves those apart that see light together
/// (simulated annealing of the frame potential, CodeSet::overlap of neighbours). Where the array
/// ends within a tile, the load of that piece counts as well.
[[nodiscard]] GroupTile scatter_tile(const GroupGrid& grid, const CodeSet& codes, int rows,
                                     int cols, Draws& draws);

/// Every group has one of the codes by chance.
[[nodiscard]] GroupTile random_tile(const CodeSet& codes, int rows, int cols, Draws& draws);

}  // namespace stipple
