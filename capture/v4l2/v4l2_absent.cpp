// Stands in for the V4L2 sources where the build leaves them out.
#include "capture/v4l2/v4l2_camera.h"
#include "core/error.h"

namespace stipple {
namespace {

constexpr const char* kWhy = "built without V4L2: configure with -DSTIPPLE_V4L2=ON";

}  // namespace

std::unique_ptr<Camera> open_v4l2_camera(const std::string& address, const CameraSettings&,
                                         const CameraBuffers&) {
    throw DeviceError(address, kWhy);
}

std::vector<CameraListing> list_v4l2_cameras() {
    throw DeviceError("V4L2 cameras", kWhy);
}

std::vector<CameraFeature> v4l2_features(const std::string& address) {
    throw DeviceError(address, kWhy);
}

std::vector<DoctorFinding> v4l2_findings() {
    return {{DoctorFinding::Level::kWarning, "V4L2", "this program cannot read V4L2 cameras",
             "configure the build with -DSTIPPLE_V4L2=ON"}};
}

}  // namespace stipple
