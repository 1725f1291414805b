#pragma once

#include <string_view>

#include "core/exposure_schedule.h"

namespace stipple {

/// True if the samples of a schedule are frames: all pixels of the tile have the same exposures,
/// one after the other and of equal length, and weights that are equal up to a factor. A pixel
/// without exposures is never read and may be among them.
[[nodiscard]] bool conventional(const ExposureSchedule& schedule);

/// The same, but with exposures of 2 to 4 lengths.
[[nodiscard]] bool alternating(const ExposureSchedule& schedule);

/// \throws InputError that names `stream` and the method, unless the schedule is conventional.
void require_conventional(const ExposureSchedule& schedule, std::string_view stream,
                          std::string_view method);

/// \throws InputError that names `stream` and the method, unless the schedule is alternating.
void require_alternating(const ExposureSchedule& schedule, std::string_view stream,
                         std::string_view method);

}  // namespace stipple
