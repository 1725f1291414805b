#include "apps/subcommands.h"

namespace stipple {

void add_capture(Command& app, Action& action) {
    Command command = app.add_command("capture", "Cameras: find, check, record, replay, serve");
    for (const auto add :
         {add_capture_list, add_capture_features, add_capture_doctor, add_capture_record,
          add_capture_live, add_capture_replay, add_capture_serve})
        add(command, action);
    command.footer(
        "Examples:\n"
        "  stipple capture list\n"
        "  stipple capture record gige:192.168.0.5 -o clip.strec --seconds 10\n"
        "  stipple emulate clip.strec -o clip.stipple");
}

}  // namespace stipple
