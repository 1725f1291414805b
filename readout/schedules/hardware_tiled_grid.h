#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/hardware_tiled_codes.h"

namespace stipple {

/// The array as a tile made for the hardware sees it: rows of groups. Groups whose numbers in a row
/// leave the same remainder by `channel_classes` load the same channels.
struct GroupGrid {
    int group_rows = 1;       ///< pixels
    int group_cols = 1;       ///< pixels
    int channel_classes = 1;  ///< 1: all groups load all channels alike
    int array_cols = 0;       ///< groups in a row of the array; 0: any number
};

/// \throws InputError if channels or a group is outside 1..65535.
[[nodiscard]] GroupGrid grid_of(const HardwareTile& tile);

/// A group near another one, and how much it matters that the two differ.
struct Neighbour {
    int row = 0;  ///< relative, in groups
    int col = 0;
    std::int32_t weight = 0;  ///< up to 256
};

/// Neighbours of a group by a Gaussian of the distance, all directions, no further than `max_rows`
/// and `max_cols`.
[[nodiscard]] std::vector<Neighbour> neighbours_of(const GroupGrid& grid, int max_rows,
                                                   int max_cols);

/// What a row of the array loads its channels with, in groups.
class RowLoadCount {
  public:
    /// For tiles of `tile_cols` groups of which one row is given, and codes of `codes`.
    RowLoadCount(const GroupGrid& grid, const CodeSet& codes);

    /// The most groups that are due in any channel and slot, where a group has the code
    /// `code_of(group)`.
    template <typename CodeOf>
    [[nodiscard]] int busiest(CodeOf&& code_of) {
        std::ranges::fill(due_, 0);
        for (int group = 0; group < cols_; ++group) add(group % classes_, code_of(group));
        return *std::ranges::max_element(due_);
    }
    /// The least that is possible: all channels and slots alike.
    [[nodiscard]] int even() const;
    /// Steps that `busiest` takes.
    [[nodiscard]] std::int64_t counted() const;

  private:
    void add(int channel_class, GroupCode code);

    const CodeSet& codes_;
    int classes_;
    int cols_;
    std::vector<int> due_;  ///< by class and slot
};

}  // namespace stipple
