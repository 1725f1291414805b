#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"

namespace stipple {

/// Times of the readout of a row, in clocks.
struct RowTimes {
    RowLoad load;
    std::int64_t select = 0;   ///< beginning of the selection
    std::int64_t convert = 0;  ///< beginning of the conversion
    std::int64_t convert_end = 0;
    std::int64_t transfer = 0;  ///< beginning of the transfer
    std::int64_t transfer_end = 0;
    std::int64_t frame_end = 0;  ///< end of the readout if this row is the last

    bool operator==(const RowTimes&) const = default;
};

/// Times of the readout of a slot, in clocks.
struct SlotTimes {
    int settle = 0;  ///< settling time, set by the row with fewest columns
    std::int64_t begin = 0;
    std::int64_t end = 0;  ///< of the readout; `begin` if no row is read
    std::vector<RowTimes> rows;

    bool operator==(const SlotTimes&) const = default;
};

/// Event-driven readout of the rows `loads` of a window of `cols` columns, from `begin` on. Each
/// step is as early as ReadoutPipeline allows. Run time grows with the rows, not with the clocks.
[[nodiscard]] SlotTimes read_slot(const ReadoutTiming& timing, int cols,
                                  std::span<const RowLoad> loads, std::int64_t begin);

/// `SlotTimes::settle` for these rows.
[[nodiscard]] int settle_of(const ReadoutTiming& timing, std::span<const RowLoad> loads);

/// Row time of a full readout of a window of `cols` columns.
[[nodiscard]] std::int64_t full_row_clocks(const ReadoutTiming& timing, int cols);

}  // namespace stipple
