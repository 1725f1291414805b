#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "stream/stream_header.h"

namespace stipple {

/// Part of the light on an array of `shape` that is collected, once the first exposures are over:
/// the open slots of each pixel, times the transmittance that `tile` gives its filter as relative
/// responsivity. Colour filters do not count: each plane is a light of its own.
[[nodiscard]] double light_throughput(const ExposureSchedule& schedule, const CalibrationTile& tile,
                                      FrameShape shape);

/// Rows [first_row, end_row) of an array in a slot.
struct SlotRows {
    std::int64_t slot = 0;
    int first_row = 0;
    int end_row = 0;
    int cols = 0;
};

/// Light that the samples of these rows hold, where a slot of light 1.0 on a pixel without filter
/// is 1.
[[nodiscard]] double light_due(const ExposureSchedule& schedule, const CalibrationTile& tile,
                               const SlotRows& rows);

/// The same of all samples of the slots 0 .. `slots` - 1. Exposures that begin before or end after
/// them are not read, so it is less than light_throughput * slots * pixels.
[[nodiscard]] double light_due_in_clip(const ExposureSchedule& schedule,
                                       const CalibrationTile& tile, FrameShape shape,
                                       std::int64_t slots);

}  // namespace stipple
