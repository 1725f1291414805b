#include "apps/arguments/camera.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdint>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/interrupt.h"
#include "capture/camera_kind.h"
#include "capture/open_camera.h"
#include "core/config.h"

namespace stipple {

void add_camera_arguments(Command& command, CameraArguments& arguments) {
    command.add_option("ADDRESS", arguments.address, address_forms()).required().input();
    add_camera_options(command, arguments);
}

void add_camera_options(Command& command, CameraArguments& arguments) {
    command
        .add_option("--config", arguments.config,
                    "settings of the camera, a file of lines Feature = value")
        .type_name("FILE")
        .input();
    command.add_option("--buffers", arguments.buffers.frames, "number of frame buffers on the host")
        .shows_default()
        .check(whole_check(CameraBuffers::kMinFrames, CameraBuffers::kMaxFrames))
        .type_name("N");
}

CameraSettings camera_settings(const CameraArguments& arguments) {
    const Config config = arguments.config.empty()
                              ? Config(arguments.settings, "camera")
                              : Config(arguments.config, arguments.settings, "camera");
    return config.entries();
}

CaptureSession::Opener image_camera_opener(const CameraArguments& arguments) {
    return [address = arguments.address, settings = camera_settings(arguments),
            buffers = arguments.buffers] {
        return interruptible([=] { return open_image_camera(address, settings, buffers); });
    };
}

bool is_replay(const CameraArguments& arguments) {
    return camera_kind(arguments.address).is_replay;
}

void add_incomplete_argument(Command& command, IncompletePolicy& policy) {
    command
        .add_choice("--incomplete", policy, kIncompletePolicies,
                    "incomplete frames: drop, keep, or mask (fill missing pixels with 0)")
        .type_name("POLICY");
}

void add_loss_argument(Command& command, bool& fails_on_loss) {
    command.add_flag("--fail-on-loss", fails_on_loss,
                     "exit code 3 if anything is lost or incomplete; the file is kept");
}

void add_session_arguments(Command& command, SessionOptions& options) {
    constexpr std::uint64_t kMaxStallMs{SessionOptions::kMaxStall.count()};
    command
        .add_parsed(
            "--stall",
            [&options](const std::string& ms) {
                options.stall = std::chrono::milliseconds(std::stoi(ms));
            },
            "open the camera again after a silence of this time and of five frame periods; "
            "0: never")
        .default_text(fmt::format("{} ms", options.stall.count()))
        .check(whole_check(0, kMaxStallMs))
        .type_name("MS");
    command.add_flag(
        "--no-reconnect", [&options] { options.reconnect = false; }, "end when the camera is lost");
}

void check_session_arguments(const Command& command, const CameraArguments& camera) {
    if (is_replay(camera))
        command.refuse({"--stall", "--no-reconnect"},
                       "a replay has no camera that could fail; leave it out");
}

void add_capture_limits(Command& command, CaptureLimits& limits) {
    command.add_option("--frames", limits.frames, "stop after N frames")
        .default_text("at Ctrl-C")
        .check(frames_check())
        .type_name("N");
    command.add_option("--seconds", limits.seconds, "stop after S seconds")
        .default_text("at Ctrl-C")
        .check(positive_check())
        .type_name("S");
}

}  // namespace stipple
