#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"
#include "capture/capture_session.h"

namespace stipple {

/// Opens the camera at `address` (camera_kind.h) and applies the settings.
/// \throws InputError for an impossible address or setting, DeviceError if the camera does not
/// answer, is in use, or refuses; both messages say what to do.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& address,
                                                  const CameraSettings& settings,
                                                  const CameraBuffers& buffers);

/// Opens the camera for its images. \throws InputError, DeviceError as open_camera; InputError if
/// it sends a coded stream, whose payloads only look like images.
[[nodiscard]] std::unique_ptr<Camera> open_image_camera(const std::string& address,
                                                        const CameraSettings& settings,
                                                        const CameraBuffers& buffers);

/// Session options without the stall timeout for a replay: a replay has an end, and the pauses of
/// its recording.
[[nodiscard]] SessionOptions session_options(const std::string& address, SessionOptions options);

}  // namespace stipple
