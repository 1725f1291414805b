#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "readout/schedules/hardware_tiled.h"
#include "readout/schedules/hardware_tiled_codes.h"

namespace stipple {

/// The array as rows of groups. Groups with the same (number in the row mod `channel_classes`) load
/// the same channels.
struct GroupGrid {
    int group_rows = 1;       ///< pixels
    int group_cols = 1;       ///< pixels
    int channel_classes = 1;  ///< 1: all groups load all channels alike
    int array_cols = 0;       ///< groups in a row of the array; 0: any number
};

/// \throws InputError if channels or a group is outside 1..65535.
[[nodiscard]] GroupGrid grid_of(const HardwareTile& tile);

/// A group near another one, and the weight of their overlap.
struct Neighbour {
    int row = 0;  ///< relative, in groups
    int col = 0;
    std::int32_t weight = 0;  ///< up to 256
};

/// Neighbours of a group by a Gaussian of the distance, all directions, no further than `max_rows`
/// and `max_cols`.
[[nodiscard]] std::vector<Neighbour> neighbours_of(const GroupGrid& grid, int max_rows,
                                                   int max_cols);

/// Load of the channels by a row of the array, in groups.
class RowLoadCount {
  public:
    /// For tiles of `tile_cols` groups of which one row is given, and codes of `codes`.
    RowLoadCount(const GroupGrid& grid, const CodeSet& codes);

    /// Max number of due groups over channels and slots, if a group has the code
    /// `code_of(group)`.
    template <typename CodeOf>
    [[nodiscard]] int busiest(CodeOf&& code_of) {
        std::ranges::fill(due_, 0);
        for (int group = 0; group < cols_; ++group) add(group % classes_, code_of(group));
        return *std::ranges::max_element(due_);
    }
    /// Lower bound of `busiest`: equal loads of all channels and slots.
    [[nodiscard]] int even() const;
    /// Number of steps of `busiest`.
    [[nodiscard]] std::int64_t counted() const;

  private:
    void add(int channel_class, GroupCode code);

    const CodeSet& codes_;
    int classes_;
    int cols_;
    std::vector<int> due_;  ///< by class and slot
};

}  // namespace stipple
