#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace stipple {

/// Opens the camera at `address` (camera_kind.h) and applies the settings.
/// \throws InputError for an impossible address or setting, DeviceError if the camera does not
/// answer, is in use, or refuses; both messages say what to do.
[[nodiscard]] std::unique_ptr<Camera> open_camera(const std::string& address,
                                                  const CameraSettings& settings,
                                                  const CameraBuffers& buffers);

}  // namespace stipple
