#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "core/memory_limit.h"
#include "stream/due_count.h"
#include "stream/packet_codec.h"
#include "stream/stream_header.h"

namespace stipple {

/// Max pixels of a calibration tile.
inline constexpr std::size_t kMaxCalibrationPixels = std::size_t{1} << 22U;

/// True if the calibration has values that the fixed part of a header does not hold.
[[nodiscard]] bool needs_calibration_section(const Calibration& calibration);

/// The calibration section of a header. \throws InputError at `where` if a value is outside its
/// limits. Precondition: needs_calibration_section(calibration).
[[nodiscard]] std::vector<std::uint8_t> encode_calibration(const Calibration& calibration,
                                                           std::string_view where);

/// The inverse: sets the values of the section in `calibration`. `section` begins at `offset` of
/// the file that messages call `where`. \throws InputError naming file and offset.
void decode_calibration(std::span<const std::uint8_t> section, std::size_t offset,
                        std::string_view where, Calibration& calibration);

/// Max weights of a tile: slots of its period x pixels.
inline constexpr std::size_t kMaxWeights = std::size_t{1} << 26U;

/// Bytes of the weights section of a schedule, if it has one.
[[nodiscard]] std::size_t weight_bytes(const ExposureSchedule& schedule);

/// The weights section of a header. \throws InputError at `where` if there are more than 2^26
/// weights. Precondition: schedule.weighted().
[[nodiscard]] std::vector<std::uint8_t> encode_weights(const ExposureSchedule& schedule,
                                                       std::string_view where);

/// The inverse: sets the weights of `schedule`. `section` begins at `offset` of the file that
/// messages call `where`. \throws InputError naming file and offset. Precondition: section.size()
/// == weight_bytes(schedule).
void decode_weights(std::span<const std::uint8_t> section, std::size_t offset,
                    std::string_view where, ExposureSchedule& schedule);

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
[[nodiscard]] std::vector<std::uint8_t> encode_schedule(const ExposureSchedule& schedule,
                                                        const ScheduleSource& source,
                                                        FrameShape shape, std::string_view where);
[[nodiscard]] inline std::vector<std::uint8_t> encode_schedule(const StreamHeader& header,
                                                               std::string_view where) {
    return encode_schedule(header.schedule, header.schedule_source, header.shape, where);
}

/// The inverse. Messages call the file `where`. \throws InputError naming file and offset, or as
/// check_memory.
[[nodiscard]] StoredSchedule decode_schedule(const ScheduleSection& section, FrameShape shape,
                                             std::string_view where, const ScheduleUse& use = {});

/// CRC-32C of the schedule in explicit form, whatever its source.
[[nodiscard]] std::uint32_t schedule_crc(const ExposureSchedule& schedule);

/// What is wrong with values of a readout, by the limits of a header; nothing if they are good.
[[nodiscard]] std::optional<std::string> readout_fault(const ReadoutValues& values);

/// The same of the name of a schedule.
[[nodiscard]] std::optional<std::string> name_fault(std::string_view name);

/// First bytes of a file, which hold the length of its header.
inline constexpr std::size_t kHeaderStartBytes = 16;

/// The bytes of a header. \throws InputError at `where` if a field is outside its limits.
[[nodiscard]] std::vector<std::uint8_t> encode_header(const StreamHeader& header,
                                                      std::string_view where);

/// Whether the first bytes of a file are those of a stream of any version.
[[nodiscard]] bool begins_as_stream(std::span<const std::uint8_t> start);

/// Length of a header. `start`: the first `kHeaderStartBytes` bytes of a file, or the whole file.
/// \throws InputError naming file and offset if it is no sample stream or of an unknown version.
[[nodiscard]] std::size_t header_bytes(std::span<const std::uint8_t> start, std::string_view where);

/// Precondition: header.size() == header_bytes(start of header).
[[nodiscard]] Framing framing_of(std::span<const std::uint8_t> header);

/// The inverse of `encode_header`. Precondition: header.size() == header_bytes(start of header).
/// \throws InputError naming file and offset, or as check_memory.
[[nodiscard]] StreamHeader decode_header(std::span<const std::uint8_t> header,
                                         std::string_view where, const ScheduleUse& use = {});

}  // namespace stipple
