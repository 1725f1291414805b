#include "apps/subcommands.h"

namespace stipple {

void add_schedule(Command& app, Action& action) {
    Command command =
        app.add_command("schedule", "Make, show, check, compile or import exposure schedules");
    for (const auto add : {add_schedule_make, add_schedule_show, add_schedule_check,
                           add_schedule_compile, add_schedule_import})
        add(command, action);
    command.footer(
        "Examples:\n"
        "  stipple schedule show two_bucket\n"
        "  stipple schedule check hardware_tiled --sensor lux1310\n"
        "  stipple schedule compile tiled -o tiled.mem\n"
        "\"stipple list schedules\" lists their names.");
}

}  // namespace stipple
