#include "apps/arguments/camera.h"

#include <chrono>
#include <string>

#include "apps/arguments/checks.h"
#include "capture/camera_kind.h"
#include "core/config.h"

namespace stipple {

void add_camera_arguments(Command& command, CameraArguments& arguments) {
    command.add_option("ADDRESS", arguments.address, address_forms()).required().input();
    command.add_option("--config", arguments.config, "settings of the camera, Feature = value")
        .type_name("FILE")
        .input();
    command.add_option("--buffers", arguments.buffers.frames, "buffers for frames on the host (32)")
        .check(whole_check(2, 1024))
        .type_name("N");
}

CameraSettings camera_settings(const CameraArguments& arguments) {
    const Config config = arguments.config.empty()
                              ? Config(arguments.settings, "camera")
                              : Config(arguments.config, arguments.settings, "camera");
    return config.entries();
}

bool is_replay(const CameraArguments& arguments) {
    return camera_kind(arguments.address).is_replay;
}

void add_incomplete_argument(Command& command, IncompletePolicy& policy) {
    command
        .add_choice("--incomplete", policy,
                    {{"drop", IncompletePolicy::kDrop},
                     {"keep", IncompletePolicy::kKeep},
                     {"mask", IncompletePolicy::kMask}},
                    "frames that did not arrive whole: drop, keep, or mask what is missing (mask)")
        .type_name("POLICY");
}

void add_session_arguments(Command& command, SessionOptions& options) {
    command
        .add_parsed(
            "--stall",
            [&options](const std::string& ms) {
                options.stall = std::chrono::milliseconds(std::stoi(ms));
            },
            "silence in ms, or 5 frame periods, after which the camera is opened anew; 0: never "
            "(250)")
        .check(whole_check(0, 3'600'000))
        .type_name("MS");
    command.add_flag(
        "--no-reconnect", [&options] { options.reconnect = false; }, "end when the camera is gone");
}

void check_session_arguments(const Command& command, const CameraArguments& camera) {
    if (is_replay(camera))
        command.refuse({"--stall", "--no-reconnect"},
                       "a replay has no camera that could fail; leave it out");
}

void add_capture_limits(Command& command, CaptureLimits& limits) {
    command.add_option("--frames", limits.frames, "stop after so many (until Ctrl-C)")
        .check(whole_check(1, std::uint64_t{1} << 53U))
        .type_name("N");
    command.add_option("--seconds", limits.seconds, "stop after so long (until Ctrl-C)")
        .check(positive_check())
        .type_name("S");
}

}  // namespace stipple
