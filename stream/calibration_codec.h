#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

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

}  // namespace stipple
