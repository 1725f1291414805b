#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace stipple {

/// Opens the camera at `address` (camera_kind.h) and sets it up.
/// \throws InputError for an address or a setting that cannot be, DeviceError if the camera does
/// not answer, is in use, or refuses; both say what to do.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& address,
                                                  const CameraSettings& settings,
                                                  const CameraBuffers& buffers);

}  // namespace stipple
