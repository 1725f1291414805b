#pragma once

#include <memory>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/camera_search.h"
#include "capture/doctor/doctor_findings.h"

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

/// The V4L2 nodes with capture and streaming, by number. \throws DeviceError if there are nodes but
/// none may be opened (the message says what to do), or if built without V4L2.
[[nodiscard]] std::vector<CameraListing> list_v4l2_cameras();

/// The controls of the device at an address, by name. \throws InputError, DeviceError as
/// open_v4l2_camera.
[[nodiscard]] std::vector<CameraFeature> v4l2_features(const std::string& address);

/// Findings on each V4L2 capture node: permission, known formats, other programs that have it open.
[[nodiscard]] std::vector<DoctorFinding> v4l2_findings();

}  // namespace stipple
