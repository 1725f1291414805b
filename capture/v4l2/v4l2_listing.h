#pragma once

#include <string>
#include <vector>

#include "capture/camera_listing.h"
#include "capture/doctor/doctor_finding.h"

namespace stipple {

/// The V4L2 nodes that capture and stream, by number. \throws DeviceError if there are nodes but
/// none may be opened, with what to do, or if built without V4L2.
[[nodiscard]] std::vector<CameraListing> list_v4l2_cameras();

/// Of every V4L2 node that captures: whether it may be opened, whether it has formats that are
/// read, and who else has it open.
[[nodiscard]] std::vector<DoctorFinding> v4l2_findings();

}  // namespace stipple
