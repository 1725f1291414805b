#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "stream/stream_header.h"

namespace stipple {

/// A schedule and how it is stored.
struct StoredSchedule {
    ExposureSchedule schedule;
    ScheduleSource source;
};

/// The schedule section of a header. \throws InputError at `place` if the schedule is beyond the
/// limits of the format, or is not what the generator of its source makes.
[[nodiscard]] std::vector<std::uint8_t> encode_schedule(const StreamHeader& header,
                                                        std::string_view place);

/// The inverse. `section` begins at `offset` of the file that messages call `place`.
/// \throws InputError naming file and offset.
[[nodiscard]] StoredSchedule decode_schedule(ScheduleSource::Kind kind,
                                             std::span<const std::uint8_t> section,
                                             FrameShape shape, std::size_t offset,
                                             std::string_view place);

/// CRC-32C of the schedule in explicit form, whatever its source.
[[nodiscard]] std::uint32_t schedule_crc(const ExposureSchedule& schedule);

}  // namespace stipple
