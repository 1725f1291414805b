#include "capture/open_camera.h"

#include <fmt/format.h>

#include "capture/camera_kind.h"
#include "core/error.h"

namespace stipple {

std::unique_ptr<Camera> open_camera(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers) {
    constexpr int kMin = CameraBuffers::kMinFrames;
    constexpr int kMax = CameraBuffers::kMaxFrames;
    if (buffers.frames < kMin || buffers.frames > kMax)
        throw InputError("buffers",
                         fmt::format("{} is outside {}..{}", buffers.frames, kMin, kMax));
    return camera_kind(address).open(address, settings, buffers);
}

}  // namespace stipple
