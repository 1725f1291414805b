#include "capture/camera_kind.h"

#include <fmt/format.h>

#include "capture/aravis/aravis_camera.h"
#include "capture/doctor/doctor_findings.h"
#include "capture/recording/replay_camera.h"
#include "capture/v4l2/v4l2_camera.h"
#include "core/error.h"

namespace stipple {
namespace {

constexpr CameraKind kKinds[] = {
    {"gige", "gige:IP", false, open_aravis_camera, list_aravis_cameras, examine_network,
     examine_genicam_camera, aravis_features},
    {"usb", "usb:SERIAL", false, open_aravis_camera, nullptr,
     [](const std::string&) { return usb_findings(); }, examine_genicam_camera, aravis_features},
    {"v4l2", "v4l2:/dev/videoN", false, open_v4l2_camera, list_v4l2_cameras,
     [](const std::string&) { return v4l2_findings(); }, nullptr, v4l2_features},
    {kReplayPrefix, "replay:FILE", true, open_replay_camera, nullptr, nullptr, nullptr},
};

}  // namespace

std::span<const CameraKind> camera_kinds() {
    return kKinds;
}

const CameraKind& camera_kind(std::string_view address) {
    for (const CameraKind& kind : kKinds)
        if (address.starts_with(fmt::format("{}:", kind.prefix))) return kind;
    throw InputError(
        address, fmt::format("is not the address of a camera: write {} (\"stipple capture list\" "
                             "shows what there is)",
                             address_forms()));
}

std::string address_forms() {
    std::string text;
    for (const CameraKind& kind : kKinds) {
        if (&kind != kKinds) text += &kind == std::end(kKinds) - 1 ? " or " : ", ";
        text += kind.address;
    }
    return text;
}

}  // namespace stipple
