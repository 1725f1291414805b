#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "calibration/chip_calibration.h"

namespace stipple {

/// The bytes of a calibration file, version 1 (docs/calibration.md). Precondition: one site
/// calibration for each site of the shape, all values within the limits of the format.
[[nodiscard]] std::vector<std::uint8_t> encode_chip_calibration(const ChipCalibration& calibration);

/// The inverse. \throws InputError naming `where` and the offset if the bytes are no calibration
/// file, of another version, too few or too many, damaged (CRC), or have a value outside its
/// limits.
[[nodiscard]] ChipCalibration decode_chip_calibration(std::span<const std::uint8_t> bytes,
                                                      std::string_view where);

/// True if `path` is a regular file that begins with the magic of a calibration file.
[[nodiscard]] bool is_chip_calibration(const std::filesystem::path& path);

/// \throws InputError as above, or if the file cannot be read.
[[nodiscard]] ChipCalibration read_chip_calibration(const std::filesystem::path& file);

}  // namespace stipple
