#pragma once

#include <optional>
#include <string>

#include "core/exposure_schedule.h"

namespace stipple {

/// Why pixels with `charge_stores` charge stores cannot do what the schedule says: names the first
/// pixel and slot in which more exposures are under way. Nothing if they can.
[[nodiscard]] std::optional<std::string> store_problem(const ExposureSchedule& schedule,
                                                       int charge_stores);

}  // namespace stipple
