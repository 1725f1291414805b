#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "calibration/chip_calibration.h"

namespace stipple {

/// The bytes of a calibration file (docs/calibration.md): version 2 if it has a response table,
/// else version 1. Precondition: one site calibration for each site of the shape, none or a table
/// of all DN, all values within the limits of the format.
[[nodiscard]] std::vector<std::uint8_t> encode_chip_calibration(const ChipCalibration& calibration);

/// The inverse. \throws InputError naming `where` and the offset if the bytes are no calibration
/// file, of another version, too few or too many, damaged (CRC), or have a value outside its
/// limits.
[[nodiscard]] ChipCalibration decode_chip_calibration(std::span<const std::uint8_t> bytes,
                                                      std::string_view where);

/// True if `path` is a regular file that begins with the magic of a calibration file.
[[nodiscard]] bool is_chip_calibration(const std::filesystem::path& path);

/// The calibration file that goes with a stream, NAME.stcal beside NAME.stipple or NAME. Empty if
/// there is none.
[[nodiscard]] std::filesystem::path calibration_beside(const std::filesystem::path& stream);

/// \throws InputError as above, or if the file cannot be read.
[[nodiscard]] ChipCalibration read_chip_calibration(const std::filesystem::path& file);

}  // namespace stipple
