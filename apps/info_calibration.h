#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// Prints the chip, the precision and the pattern of a calibration. \throws InputError if it is
/// damaged, DeviceError.
void info_calibration(const std::string& file, const RunOptions& run);

}  // namespace stipple
