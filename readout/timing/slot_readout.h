#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"

namespace stipple {

/// When a row of a slot is read, in clocks.
struct RowTimes {
    RowLoad load;
    std::int64_t select = 0;  ///< begins
    std::int64_t convert = 0;
    std::int64_t convert_end = 0;
    std::int64_t transfer = 0;
    std::int64_t transfer_end = 0;
    std::int64_t end_if_last = 0;  ///< of the readout, if no row came after this one

    bool operator==(const RowTimes&) const = default;
};

/// When the rows of a slot are read, in clocks.
struct SlotTimes {
    int settle = 0;  ///< time of settling: what the sensor takes for the row with fewest columns
    std::int64_t begin = 0;
    std::int64_t end = 0;  ///< of the readout; `begin` if no row is read
    std::vector<RowTimes> rows;

    bool operator==(const SlotTimes&) const = default;
};

/// The readout of the rows `loads` of a window of `cols` columns, from `begin` on, each step as
/// early as ReadoutPipeline allows. Time grows with the rows, not with the clocks.
[[nodiscard]] SlotTimes read_slot(const ReadoutTiming& timing, int cols,
                                  std::span<const RowLoad> loads, std::int64_t begin);

/// What `SlotTimes::settle` is for these rows.
[[nodiscard]] int settle_of(const ReadoutTiming& timing, std::span<const RowLoad> loads);

/// From row to row in a window of `cols` columns that is read in full.
[[nodiscard]] std::int64_t full_row_clocks(const ReadoutTiming& timing, int cols);

}  // namespace stipple
