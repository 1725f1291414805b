#pragma once

#include <string>
#include <vector>

#include "capture/camera_listing.h"
#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// The V4L2 nodes with capture and streaming, by number. \throws DeviceError if there are nodes but
/// none may be opened (the message says what to do), or if built without V4L2.
[[nodiscard]] std::vector<CameraListing> list_v4l2_cameras();

/// The controls of the device at an address, by name. \throws InputError, DeviceError as
/// open_v4l2_camera.
[[nodiscard]] std::vector<CameraFeature> v4l2_features(const std::string& address);

/// Findings on each V4L2 capture node: permission, known formats, other programs that have it open.
[[nodiscard]] std::vector<DoctorFinding> v4l2_findings();

}  // namespace stipple
