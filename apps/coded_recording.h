#pragma once

#include "apps/arguments/run_options.h"
#include "apps/camera_recording.h"

namespace stipple {

/// Records the coded stream of a camera of `capture serve --mode coded` as the .stipple file that
/// `emulate` would have written. Slots that did not arrive are dropped packets in it, and counted.
/// \throws InputError, DeviceError.
void record_coded_stream(const CameraRecordingArguments& arguments, const RunOptions& run);

}  // namespace stipple
