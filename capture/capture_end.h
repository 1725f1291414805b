#pragma once

#include <string>

#include "capture/live_emulator.h"
#include "capture/recording/camera_recorder.h"
#include "capture/recording/coded_recorder.h"

namespace stipple {

// How captures end. `address` is that of the camera, for messages.

/// \throws what ended a recording too early: InputError, DeviceError, std::bad_alloc; DeviceError
/// if there is no frame.
void throw_early_end(const CameraRecording& recording, const std::string& address);
void throw_early_end(const CodedRecording& recording, const std::string& address);

/// Puts the stream in place, as far as it goes. An error meanwhile becomes the `failure` of the
/// emulation. Whether the stream is kept in spite of a failure. \throws DeviceError.
bool commit_recording(StreamRecorder& recorder, LiveEmulation& emulation);

/// The same for an emulation. Precondition: its stream is in place, if there is a frame.
void throw_early_end(const LiveEmulation& emulation, const std::string& address);

}  // namespace stipple
