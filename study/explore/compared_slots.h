#pragma once

#include <cstdint>
#include <string>

#include "core/exposure_schedule.h"
#include "study/explore/space.h"
#include "study/explore/trial.h"

namespace stipple {

/// The slots, of `slots` from the first one on, that no exposure touches which an end of the clip
/// cuts: a running sensor would have those too. The sensor is reset at the beginning of slot
/// `phase_slots`. Nothing left: begin >= end.
[[nodiscard]] ComparedSlots whole_slots(const ExposureSchedule& schedule, std::int64_t phase_slots,
                                        int slots);

/// The slots of a clip that all points of a space compare: `space.compared`, else those that are
/// whole for all sensors of all points, without the usual margin; the margin alone if fewer than a
/// quarter of the slots were left. Points that cannot be set up have no say, systems that
/// Space::replace has left out do. \throws TrialStopped.
[[nodiscard]] ComparedSlots compared_slots(const Space& space, const TrialLight& light, int slots,
                                           const KeepGoing& keep_going);

}  // namespace stipple
