#pragma once

#include <cstdint>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// Lengths in clocks of the first slots of a chip that waits where it must
/// (OverrunPolicy::kStretch), clock by clock: each row keeps its samples until the one scan has
/// read it, and no slot ends before the rows that are due at its end are free. On a chip that
/// cannot expose while it reads, no clock of a scan counts for the exposure of a slot in which a
/// pixel is open. The reference of ReadoutCost.
[[nodiscard]] std::vector<std::int64_t> slot_lengths_by_ticks(const ReadoutTiming& timing,
                                                              const ExposureSchedule& schedule,
                                                              FrameShape shape, std::int64_t budget,
                                                              int slots);

}  // namespace stipple
