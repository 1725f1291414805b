#pragma once

#include <string>

#include "capture/recording/recording_footage.h"

namespace stipple {

/// What is wrong with a recording named `file` that was read to its end: damage, no end, frames
/// that are missing or incomplete. Empty if nothing is.
[[nodiscard]] std::string recording_faults(const std::string& file,
                                           const RecordingFootage& footage);

}  // namespace stipple
