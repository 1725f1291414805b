#include "capture/open_camera.h"

#include <fmt/format.h>

#include "capture/aravis/aravis_camera.h"
#include "capture/recording/replay_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "core/error.h"

namespace stipple {

std::unique_ptr<Camera> open_camera(const std::string& address, const CameraSettings& settings,
                                    const CameraBuffers& buffers) {
    const std::string kind = address.substr(0, address.find(':') + 1);
    if (buffers.frames < 2 || buffers.frames > 1024)
        throw InputError("buffers", fmt::format("{} is outside 2..1024", buffers.frames));
    if (kind == "gige:" || kind == "usb:") return open_aravis_camera(address, settings, buffers);
    if (kind == "v4l2:") return open_v4l2_camera(address, settings, buffers);
    if (kind == "replay:") return open_replay_camera(address, settings, buffers);
    throw InputError(address,
                     "is no address of a camera: write gige:IP, usb:SERIAL, v4l2:/dev/videoN or "
                     "replay:FILE (`stipple capture list` shows what there is)");
}

}  // namespace stipple
