// Stands in for the V4L2 sources where the build leaves them out.
#include "capture/v4l2_camera.h"
#include "core/error.h"

namespace stipple {

std::unique_ptr<Camera> open_v4l2_camera(const std::string& address, const CameraSettings&,
                                         const CameraBuffers&) {
    throw DeviceError(address, "built without V4L2: configure with -DSTIPPLE_V4L2=ON");
}

}  // namespace stipple
