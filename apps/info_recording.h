#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// Prints camera, frames, rate, gaps, settings and condition of a recording. \throws InputError if
/// it is damaged (after printing), DeviceError, Interrupted.
void info_recording(const std::string& file, const RunOptions& run);

}  // namespace stipple
