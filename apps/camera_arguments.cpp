#include "apps/camera_arguments.h"

#include <fmt/format.h>

#include "apps/number_check.h"
#include "capture/camera_kind.h"
#include "capture/open_camera.h"
#include "core/config.h"
#include "core/error.h"

namespace stipple {

void add_camera_arguments(Command& command, CameraArguments& arguments) {
    command.add_option("ADDRESS", arguments.address, address_forms()).required().input();
    command.add_option("--config", arguments.config, "settings of the camera, Feature = value")
        .type_name("FILE")
        .input();
    command
        .add_option("--buffers", arguments.buffers.frames,
                    "frames that the host can hold while we are busy (32)")
        .check(whole_check(2, 1024))
        .type_name("N");
}

CameraSettings camera_settings(const CameraArguments& arguments) {
    const Config config = arguments.config.empty()
                              ? Config(arguments.settings, "camera")
                              : Config(arguments.config, arguments.settings, "camera");
    return config.entries();
}

std::unique_ptr<Camera> open_picture_camera(const CameraArguments& arguments,
                                            const CameraSettings& settings) {
    auto camera = open_camera(arguments.address, settings, arguments.buffers);
    if (!camera->description().features.contains("CodedStreamHeader")) return camera;
    const std::string place = arguments.address + ": CodedStreamHeader";
    if (is_replay(arguments))
        throw InputError(place,
                         "what was recorded is a coded stream, not pictures; record the camera "
                         "anew with \"stipple capture record --coded\"");
    throw InputError(place,
                     fmt::format("the camera sends a coded stream, not pictures; write it "
                                 "with \"stipple capture record --coded {} -o FILE.stipple\"",
                                 arguments.address));
}

bool is_replay(const CameraArguments& arguments) {
    return camera_kind(arguments.address).is_replay;
}

SessionOptions session_options(const CameraArguments& arguments, SessionOptions options) {
    if (!is_replay(arguments)) return options;
    options.reconnect = false;
    options.stall = std::chrono::milliseconds(0);
    return options;
}

}  // namespace stipple
