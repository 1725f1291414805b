#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// Says what a recording of a camera is and holds: frames, rate, gaps, settings, and how far it is
/// whole. \throws InputError if it is damaged (once all was said), DeviceError, Interrupted.
void info_recording(const std::string& file, const RunOptions& run);

}  // namespace stipple
