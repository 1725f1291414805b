#pragma once

#include "readout/schedules/hardware_tiled_grid.h"

namespace stipple {

/// A tile of any size. First each row gets codes for each class of channels that balance the slots:
/// whole sets (one order begun in every slot of the period), and the result of a search for the
/// remaining groups, with the same load in all channels. Then groups of one row and class exchange
/// their codes, which keeps the loads and minimises the frame potential (simulated annealing,
/// CodeSet::overlap of neighbours). If the array ends within a tile, the load of this part of the
/// tile counts too.
[[nodiscard]] GroupTile scatter_tile(const GroupGrid& grid, const CodeSet& codes, int rows,
                                     int cols, Draws& draws);

/// A random code for each group.
[[nodiscard]] GroupTile random_tile(const CodeSet& codes, int rows, int cols, Draws& draws);

}  // namespace stipple
