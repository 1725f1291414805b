#pragma once

#include <string>

#include "calibration/chip_calibration.h"
#include "stream/stream_header.h"

namespace stipple {

/// The calibration of a stream's chip. \throws InputError as read_chip_calibration and
/// require_same_chip.
[[nodiscard]] ChipCalibration read_calibration(const std::string& file, const StreamHeader& header);

/// Warns that a stream of this chip is decoded without calibration, and what that costs a sample at
/// half of saturation, N electrons:
///
///     10 log10(1 + (PRNU^2 N^2 + DSNU^2 + column noise^2) / (N + read noise^2))   dB of SNR
///
/// and that its response is non-linear. Empty below 0.1 dB, of a linear chip.
[[nodiscard]] std::string fixed_pattern_warning(const std::string& stream,
                                                const StreamHeader& header);

}  // namespace stipple
