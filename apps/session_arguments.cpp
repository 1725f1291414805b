#include "apps/session_arguments.h"

#include <chrono>
#include <string>

#include "apps/number_check.h"

namespace stipple {

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

}  // namespace stipple
