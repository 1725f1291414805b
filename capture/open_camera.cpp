#include "capture/open_camera.h"

#include <fmt/format.h>

#include "capture/camera_kind.h"
#include "core/error.h"

namespace stipple {

std::unique_ptr<Camera> open_camera(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers) {
    if (buffers.frames < 2 || buffers.frames > 1024)
        throw InputError("buffers", fmt::format("{} is outside 2..1024", buffers.frames));
    return camera_kind(address).open(address, settings, buffers);
}

}  // namespace stipple
