#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "core/memory_limit.h"
#include "stream/due_count.h"
#include "stream/stream_header.h"

namespace stipple {

/// A schedule and its storage.
struct StoredSchedule {
    ExposureSchedule schedule;
    ScheduleSource source;
    std::uint32_t crc = 0;  ///< CRC-32C of the schedule in explicit form, whatever its source
};

/// The schedule section of a header, which begins at `offset` of the file.
struct ScheduleSection {
    ScheduleSource::Kind kind = ScheduleSource::Kind::kExplicit;
    std::span<const std::uint8_t> bytes;
    std::size_t offset = 0;
};

/// How a reader uses a schedule.
struct ScheduleUse {
    /// If set, a random schedule is not stored: its pixels are counted here, and `schedule` has a
    /// tile of one pixel, the first, which has the same figures as all others.
    std::optional<DueCounts>* counts = nullptr;
    std::uint64_t input_bytes = kEndlessInput;  ///< as of check_memory
};

/// The schedule section of a header. \throws InputError at `where` if the schedule exceeds the
/// limits of the format, or differs from the output of its generator.
[[nodiscard]] std::vector<std::uint8_t> encode_schedule(const StreamHeader& header,
                                                        std::string_view where);

/// The inverse. Messages call the file `where`. \throws InputError naming file and offset, or as
/// check_memory.
[[nodiscard]] StoredSchedule decode_schedule(const ScheduleSection& section, FrameShape shape,
                                             std::string_view where, const ScheduleUse& use = {});

/// CRC-32C of the schedule in explicit form, whatever its source.
[[nodiscard]] std::uint32_t schedule_crc(const ExposureSchedule& schedule);

}  // namespace stipple
