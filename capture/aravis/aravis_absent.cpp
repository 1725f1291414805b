#include "capture/aravis/aravis_camera.h"
#include "capture/doctor/doctor_findings.h"
#include "capture/open_camera.h"
#include "core/error.h"

namespace stipple {

std::unique_ptr<Camera> open_aravis_camera(const std::string& address, const CameraSettings&,
                                           const CameraBuffers&) {
    throw DeviceError(address, "built without Aravis: configure with -DSTIPPLE_ARAVIS=ON");
}

void tell_camera_messages(std::function<void(std::string_view)>) {}

std::vector<CameraListing> list_aravis_cameras() {
    throw DeviceError("GenICam cameras",
                      "built without Aravis: configure with -DSTIPPLE_ARAVIS=ON");
}

std::vector<CameraFeature> aravis_features(const std::string& address) {
    throw DeviceError(address, "built without Aravis: configure with -DSTIPPLE_ARAVIS=ON");
}

std::vector<DoctorFinding> examine_genicam_camera(const std::string&) {
    return {{DoctorFinding::Level::kProblem, "camera", "built without Aravis",
             "configure with -DSTIPPLE_ARAVIS=ON"}};
}

}  // namespace stipple
