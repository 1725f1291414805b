#pragma once

#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {

/// A cell of pixels. Each pixel repeats one exposure with its own interval and offset. Lists have
/// one value per pixel, row by row.
struct Cell {
    int rows = 1;
    int cols = 1;
    std::vector<int> exposure_slots;  ///< 1..64
    std::vector<int> every_slots;     ///< from the beginning of an exposure to that of the next
    std::vector<int> first_slots;     ///< beginning of the first one, 0 or more
};

/// The period is the least common multiple of all `every_slots`. \throws InputError naming the
/// pixel whose exposure is longer than its `every_slots`, or if the period is beyond 65535
/// slots or 2^24 exposures.
[[nodiscard]] ExposureSchedule cell_schedule(const Cell& cell);

/// A rolling shutter: in each slot the next `rows_per_slot` rows begin an exposure.
struct RollingShutter {
    int exposure_slots = 1;  ///< 1..64, at most the period
    int period_slots = 1;    ///< from one exposure of a row to the next, 1..65535
    int rows_per_slot = 1;   ///< 1 or more
};

/// The tile has the rows that begin within a period, but no more than `array_rows`.
/// \throws InputError if a number is out of range.
[[nodiscard]] ExposureSchedule rolling_schedule(const RollingShutter& shutter, int array_rows);

}  // namespace stipple
