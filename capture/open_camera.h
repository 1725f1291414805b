#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

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

/// From now on `tell` gets what GLib and Aravis say of a camera, which standard error got before:
/// the first 200 bytes of each text, once, of at most 20 texts. They may hold bytes of the camera.
/// `tell` is called by any thread, of the whole process; it must not throw.
void tell_camera_messages(std::function<void(std::string_view)> tell);

/// Session options without the stall timeout for a replay: a replay has an end, and the pauses of
/// its recording.
[[nodiscard]] SessionOptions session_options(const std::string& address, SessionOptions options);

}  // namespace stipple
