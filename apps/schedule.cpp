#include <CLI/CLI.hpp>

#include "apps/schedule_commands.h"
#include "apps/subcommands.h"

namespace stipple {

void add_schedule(CLI::App& app, Action& action) {
    auto* command =
        app.add_subcommand("schedule", "Make, show, check, compile or import exposure schedules");
    command->require_subcommand(1);
    for (const auto add : {add_schedule_make, add_schedule_show, add_schedule_check,
                           add_schedule_compile, add_schedule_import})
        add(*command, action);
}

}  // namespace stipple
