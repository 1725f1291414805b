#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "calibration/chip_calibration.h"
#include "core/message.h"
#include "stream/stream_reader.h"

namespace stipple {

/// The calibration file that a stream is decoded with; an empty path: none; no value: the one
/// beside the stream (calibration_beside), if there is one.
using CalibrationChoice = std::optional<std::filesystem::path>;

/// As users write it: a file, "none", or nothing for the one beside the stream.
[[nodiscard]] CalibrationChoice calibration_choice(const std::filesystem::path& text);

/// The file that is chosen; empty: none.
[[nodiscard]] std::filesystem::path calibration_file(const std::filesystem::path& stream,
                                                     const CalibrationChoice& choice);

/// The calibration of a stream's chip. \throws InputError as read_chip_calibration and
/// require_same_chip.
[[nodiscard]] ChipCalibration read_calibration(const std::filesystem::path& file,
                                               const StreamHeader& header);

/// Decodes the stream with the calibration of its chip; the stream has the name of its file.
/// Returns a warning if it has none, and that costs something (fixed_pattern_warning).
/// Precondition: no packet has been read. \throws InputError as read_calibration.
[[nodiscard]] Message calibrate(StreamReader& stream, const CalibrationChoice& choice);

/// Warns that a stream of this chip is decoded without calibration, and what that costs a sample at
/// half of saturation, N electrons:
///
///     10 log10(1 + (PRNU^2 N^2 + DSNU^2 + column noise^2) / (N + read noise^2))   dB of SNR
///
/// and that its response is non-linear. Empty below 0.1 dB, of a linear chip.
[[nodiscard]] Message fixed_pattern_warning(const std::string& stream, const StreamHeader& header);

}  // namespace stipple
