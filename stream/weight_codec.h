#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"

namespace stipple {

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

}  // namespace stipple
