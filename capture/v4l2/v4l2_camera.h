#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace stipple {

/// A camera at a V4L2 node, through the ioctls of the kernel (without libv4l, which would convert).
/// `address` is "v4l2:/dev/video0", "v4l2:/dev/v4l/by-id/..." or "v4l2:0".
///
/// Settings besides the common ones: `Input` is the number of the input, from 0; `BufferMemory` is
/// `driver` (mapped, the default) or `own` (user pointers); any other is a control by its name in
/// v4l2-ctl ("gain", "test_pattern"), menus by number or text.
///
/// Frames with V4L2_BUF_FLAG_ERROR have the status kDeviceError, frames of another size than the
/// layout kSizeMismatch. Missing bytes are zero. `counts().underruns` counts the sequence numbers
/// that are missing after all buffers were full.
///
/// Not supported: formats of several memory planes, compressed formats, interlaced fields.
/// \throws InputError for impossible settings, DeviceError for a device that refuses
[[nodiscard]] std::unique_ptr<Camera> open_v4l2_camera(const std::string& address,
                                                       const CameraSettings& settings,
                                                       const CameraBuffers& buffers);

}  // namespace stipple
