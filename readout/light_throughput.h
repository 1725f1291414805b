#pragma once

#include <cstdint>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "stream/stream_header.h"

namespace stipple {

/// Fraction of the light on an array of `shape` that is collected in steady slots: the open slots
/// of each pixel, weighted by the transmittance of its filter, which `tile` has as relative
/// responsivity. Colour filters have no weight: each plane counts separately.
[[nodiscard]] double light_throughput(const ExposureSchedule& schedule, const CalibrationTile& tile,
                                      FrameShape shape);

/// Rows [first_row, end_row) of an array in a slot.
struct SlotRows {
    std::int64_t slot = 0;
    int first_row = 0;
    int end_row = 0;
    int cols = 0;
};

/// Light that the samples of these rows hold. Unit: one slot of light 1.0 on a pixel without
/// filter.
[[nodiscard]] double light_due(const ExposureSchedule& schedule, const CalibrationTile& tile,
                               const SlotRows& rows);

/// The earliest slot with the same exposures due.
[[nodiscard]] std::int64_t kind_of_slot(const ExposureSchedule& schedule, std::int64_t slot);

/// The same for all samples of the slots 0 .. `slots` - 1. Exposures that begin before or end after
/// them are not read, so it is less than light_throughput * slots * pixels.
[[nodiscard]] double light_due_in_clip(const ExposureSchedule& schedule,
                                       const CalibrationTile& tile, FrameShape shape,
                                       std::int64_t slots);

}  // namespace stipple
