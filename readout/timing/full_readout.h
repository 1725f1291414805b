#pragma once

#include <cstdint>

#include "core/geometry.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// The readout of equal rows, by formula. All in clocks but `channel_columns`.
struct UniformReadout {
    int channel_columns = 0;   ///< of the busiest channel
    int settle = 0;            ///< time of settling that the sensor chooses
    std::int64_t convert = 0;  ///< of a row, its selection included
    std::int64_t transfer = 0;
    std::int64_t row = 0;    ///< from row to row
    std::int64_t lead = 0;   ///< before the first transfer, or, where conversion and transfer take
                             ///< turns, before the first row
    std::int64_t total = 0;  ///< lead + rows, dark ones included
};

/// The readout of a whole window of `shape` (its planes are read side by side):
///     overhead + [convert +] rows x row,    row as the sensor's row timing says.
/// \throws InputError if the array is smaller.
[[nodiscard]] UniformReadout full_readout(const ReadoutTiming& timing, FrameShape shape);

/// A bound of readouts, in clocks, on the average.
struct BalancedReadout {
    double row = 0;    ///< from row to row
    double total = 0;  ///< as of UniformReadout
};

/// The least that a readout takes if every row is read but only `share` of the columns, as evenly
/// over rows, channels and ADCs as whole columns allow: no schedule of as many samples that leaves
/// no row out is read faster on average. Rows may differ by a column, so the row time is that of
/// the greatest convex function below the times of 1, 2, ... columns. Dark rows and overhead are as
/// in full. A sensor with a choice of settling times settles for the mean load, and may be faster
/// where some row has less. Precondition: 0 < share <= 1.
[[nodiscard]] BalancedReadout balanced_readout(const ReadoutTiming& timing, FrameShape shape,
                                               double share);

}  // namespace stipple
