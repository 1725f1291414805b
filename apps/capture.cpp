#include <CLI/CLI.hpp>

#include "apps/capture_commands.h"
#include "apps/subcommands.h"

namespace stipple {

void add_capture(CLI::App& app, Action& action) {
    auto* command = app.add_subcommand("capture", "Cameras: find, check, record, replay, serve");
    command->require_subcommand(1);
    for (const auto add : {add_capture_list, add_capture_doctor, add_capture_record,
                           add_capture_live, add_capture_replay, add_capture_serve})
        add(*command, action);
}

}  // namespace stipple
