#include "apps/session_arguments.h"

#include <CLI/CLI.hpp>
#include <map>

#include "apps/unused_options.h"

namespace stipple {

void add_session_arguments(CLI::App& command, SessionOptions& options) {
    static const std::map<std::string, IncompletePolicy> kPolicies{
        {"drop", IncompletePolicy::kDrop},
        {"keep", IncompletePolicy::kKeep},
        {"mask", IncompletePolicy::kMask}};
    command
        .add_option_function<std::string>(
            "--incomplete",
            [&options](const std::string& name) { options.incomplete = kPolicies.at(name); },
            "frames that did not arrive whole: drop, keep, or mask what is missing (mask)")
        ->check(CLI::IsMember({"drop", "keep", "mask"}))
        ->type_name("POLICY");
    command
        .add_option_function<int>(
            "--stall", [&options](int ms) { options.stall = std::chrono::milliseconds(ms); },
            "silence in ms, or 5 frame periods, after which the camera is opened anew; 0: never "
            "(250)")
        ->check(CLI::Range(0, 3'600'000))
        ->type_name("MS");
    command.add_flag_callback(
        "--no-reconnect", [&options] { options.reconnect = false; }, "end when the camera is gone");
}

void check_session_arguments(const CLI::App& command, const CameraArguments& camera) {
    if (is_replay(camera))
        refuse_options(command, {"--stall", "--no-reconnect"},
                       "a replay has no camera that could fail; leave it out");
}

}  // namespace stipple
