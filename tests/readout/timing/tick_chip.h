#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/geometry.h"
#include "core/schedule_parts.h"
#include "readout/timing/readout_timing.h"

namespace stipple {

/// Lengths in clocks of the first slots of a chip that waits where it must
/// (OverrunPolicy::kStretch), clock by clock: each row keeps its samples until the one scan has
/// read it, and no slot ends before the rows that are due at its end are free. On a chip that
/// cannot expose while it reads, no clock of a scan counts for the exposure of a slot in which a
/// pixel is open. Between two parts of the schedule no row waits, and what the second one reads is
/// due. The reference of ReadoutCost.
[[nodiscard]] std::vector<std::int64_t> slot_lengths_by_ticks(const ReadoutTiming& timing,
                                                              std::span<const SchedulePart> parts,
                                                              FrameShape shape, std::int64_t budget,
                                                              int slots);

}  // namespace stipple
