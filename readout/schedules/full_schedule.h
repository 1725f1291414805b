#pragma once

#include "core/exposure_schedule.h"

namespace stipple {

/// Every pixel of the array exposes `open_slots` slots together, every `period_slots` slots: a
/// conventional camera. \throws InputError unless 1 <= open_slots <= 64, open_slots <= period.
[[nodiscard]] ExposureSchedule full_schedule(int open_slots, int period_slots);

}  // namespace stipple
