#pragma once

#include <memory>
#include <string>

#include "capture/camera.h"

namespace stipple {

/// A camera behind a V4L2 node, spoken to by the kernel's ioctls (no libv4l, which would convert).
/// `address` is "v4l2:/dev/video0", "v4l2:/dev/v4l/by-id/..." or "v4l2:0".
///
/// Settings beside those that mean the same for all cameras: `Input` is the number of the input,
/// from 0; `BufferMemory` is `driver` (mapped, the default) or `own` (user pointers); any other is
/// a control by its name in v4l2-ctl ("gain", "test_pattern"), menus by number or text.
///
/// Frames with V4L2_BUF_FLAG_ERROR are kDeviceError, those of another size than the layout asks for
/// kSizeMismatch; what was not received is zero. `counts().underruns` are sequence numbers that are
/// missing after all buffers had been full.
///
/// Not modelled: formats of several memory planes, compressed formats, interlaced fields.
/// \throws InputError for settings that cannot be meant, DeviceError for a device that refuses
[[nodiscard]] std::unique_ptr<Camera> open_v4l2_camera(const std::string& address,
                                                       const CameraSettings& settings,
                                                       const CameraBuffers& buffers);

}  // namespace stipple
