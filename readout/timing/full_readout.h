#pragma once

#include <cstdint>

#include "core/geometry.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// The readout of equal rows, by formula. All in clocks except `channel_columns`.
struct UniformReadout {
    int channel_columns = 0;   ///< of the busiest channel
    int settle = 0;            ///< settling time
    std::int64_t convert = 0;  ///< of a row, selection included
    std::int64_t transfer = 0;
    std::int64_t row = 0;    ///< row time
    std::int64_t lead = 0;   ///< before the first transfer, or, where conversion and transfer take
                             ///< turns, before the first row
    std::int64_t total = 0;  ///< lead + rows, dark ones included
};

/// The readout of a whole window of `shape` (its planes are read side by side):
///     overhead + [convert +] rows x row,    row as the sensor's row timing says.
/// \throws InputError if the array is smaller.
[[nodiscard]] UniformReadout full_readout(const ReadoutTiming& timing, FrameShape shape);

/// Lower bound of a readout, mean clocks.
struct BalancedReadout {
    double row = 0;    ///< mean row time
    double total = 0;  ///< as of UniformReadout
};

/// Lower bound of the time of a readout that reads the fraction `share` of the columns in every
/// row, balanced over rows, channels and ADCs in whole columns. No schedule with the same number of
/// samples that reads every row is faster on average. Rows may differ by a column, so the row time
/// is the greatest convex function below the times of 1, 2, ... columns. Dark rows and overhead are
/// those of a full readout. With several settling times, that of the mean load is used; rows with
/// less load may be faster. Precondition: 0 < share <= 1.
[[nodiscard]] BalancedReadout balanced_readout(const ReadoutTiming& timing, FrameShape shape,
                                               double share);

}  // namespace stipple
