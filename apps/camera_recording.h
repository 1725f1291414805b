#pragma once

#include <cstdint>
#include <string>

#include "apps/arguments/camera.h"
#include "apps/arguments/run_options.h"
#include "capture/capture_session.h"

namespace stipple {

/// What `stipple capture record` was asked for.
struct CameraRecordingArguments {
    CameraArguments camera;
    SessionOptions session;
    std::string output;  ///< file, or a folder in which a file named by the time is made
    CaptureLimits limits;
    bool coded = false;  ///< the samples of a camera of `capture serve --mode coded`
};

/// Records a camera until the frames or seconds are reached, a signal asks to stop, or the camera
/// is lost for good, and says what became of every frame. What was recorded is kept whatever
/// happens. \throws InputError, DeviceError (after the recording was put in place, if frames are in
/// it).
void record_camera(const CameraRecordingArguments& arguments, const RunOptions& run);

}  // namespace stipple
