#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace stipple {

/// The kind of camera that an address names: "gige", "usb", "v4l2" or "replay". \throws InputError
/// if none.
[[nodiscard]] std::string camera_kind(const std::string& address);

/// Opens the camera at `address` and sets it up. Addresses are "gige:IP", "usb:SERIAL",
/// "v4l2:/dev/videoN" and "replay:FILE".
/// \throws InputError for an address or a setting that cannot be, DeviceError if the camera does
/// not answer, is in use, or refuses; both say what to do.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& address,
                                                  const CameraSettings& settings,
                                                  const CameraBuffers& buffers);

}  // namespace stipple
