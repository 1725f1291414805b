#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"
#include "capture/capture_session.h"

namespace stipple {

/// Opens the camera for its images. \throws InputError, DeviceError as open_camera; InputError if
/// what it sends is a coded stream, whose payloads only look like images.
[[nodiscard]] std::unique_ptr<Camera> open_image_camera(const std::string& address,
                                                        const CameraSettings& settings,
                                                        const CameraBuffers& buffers);

/// What a session may take for a fault: a replay has an end, and pauses where the recording has
/// them.
[[nodiscard]] SessionOptions session_options(const std::string& address, SessionOptions options);

}  // namespace stipple
