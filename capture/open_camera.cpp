#include "capture/open_camera.h"

#include <fmt/format.h>

#include <chrono>

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

std::unique_ptr<Camera> open_image_camera(const std::string& address,
                                          const CameraSettings& settings,
                                          const CameraBuffers& buffers) {
    auto camera = open_camera(address, settings, buffers);
    if (!camera->description().features.contains("CodedStreamHeader")) return camera;
    const std::string where = address + ": CodedStreamHeader";
    if (camera_kind(address).is_replay)
        throw InputError(where,
                         "what was recorded is a coded stream, not images; record the camera "
                         "anew with " +
                             Parameter{"coded", "true"});
    throw InputError(
        where, "the camera sends a coded stream, not images; \"capture record\" writes it with " +
                   Parameter{"coded", "true"});
}

SessionOptions session_options(const std::string& address, SessionOptions options) {
    if (!camera_kind(address).is_replay) return options;
    options.reconnect = false;
    options.stall = std::chrono::milliseconds(0);
    return options;
}

}  // namespace stipple
