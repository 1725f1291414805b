#include "capture/open_camera.h"

#include <fmt/format.h>

#include "capture/aravis/aravis_camera.h"
#include "capture/recording/replay_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "core/error.h"

namespace stipple {

std::string camera_kind(const std::string& address) {
    const auto colon = address.find(':');
    for (const char* kind : {"gige", "usb", "v4l2", "replay"})
        if (colon != std::string::npos && address.substr(0, colon) == kind) return kind;
    throw InputError(address,
                     "is no address of a camera: write gige:IP, usb:SERIAL, v4l2:/dev/videoN or "
                     "replay:FILE (\"stipple capture list\" shows what there is)");
}

std::unique_ptr<Camera> open_camera(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers) {
    if (buffers.frames < 2 || buffers.frames > 1024)
        throw InputError("buffers", fmt::format("{} is outside 2..1024", buffers.frames));
    const std::string kind = camera_kind(address);
    if (kind == "v4l2") return open_v4l2_camera(address, settings, buffers);
    if (kind == "replay") return open_replay_camera(address, settings, buffers);
    return open_aravis_camera(address, settings, buffers);
}

}  // namespace stipple
