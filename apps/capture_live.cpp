#include <nlohmann/json.hpp>

#include "apps/arguments/camera.h"
#include "apps/arguments/checks.h"
#include "apps/arguments/output_names.h"
#include "apps/arguments/sensor.h"
#include "apps/live_emulation.h"
#include "apps/report/json_file.h"
#include "apps/subcommands.h"

namespace stipple {
namespace {

void live(const LiveArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    if (!arguments.preview.file.empty()) check_preview_file(arguments.preview, run.force);
    LiveEmulation emulation(arguments, run);
    emulation.run(run);
    emulation.finish();
    json.write(emulation.json());
    run.say(emulation.text());
}

}  // namespace

void add_capture_live(Command& capture, Action& action) {
    Command command = capture.add_command("live", "A camera through the sensor as it runs");
    const auto options = std::make_shared<LiveArguments>();
    add_camera_arguments(command, options->camera);
    command.add_option("-o,--output", options->output, "sample stream")
        .type_name("FILE")
        .required()
        .output(kStreamName);
    add_capture_limits(command, options->limits);
    add_sensor_arguments(command, options->sensor);
    auto sections = sensor_sections(options->sensor);
    sections.push_back({"camera", &options->camera.settings});
    add_settings(command, std::move(sections),
                 "change a key of the sensor or of the schedule, or set a feature of the camera");
    add_preview_arguments(command, options->preview);
    add_session_arguments(command, options->session);
    command.add_option("--black-level", options->black_level_dn, "DN without light (0)")
        .check(number_check(0))
        .type_name("DN");
    command.add_option("--queue", options->queue_frames, "frames that may wait (64)")
        .check(whole_check(1, 4096))
        .type_name("N");
    command
        .add_option("--late-after", options->late_after_slots,
                    "a packet is late so many slots after its frame (2)")
        .check(positive_check())
        .type_name("N");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple capture live gige:192.168.0.5 -o clip.stipple --seconds 10\n"
        "  stipple capture live v4l2:/dev/video0 -o clip.stipple --preview now.png\n"
        "  stipple capture live replay:clip.strec -o clip.stipple --schedule tiled");
    set_action(command, action, options, live, [command, options] {
        if (options->preview.file.empty())
            command.refuse({"--preview-method", "--preview-size"},
                           "there is no preview; add --preview FILE or leave it out");
        check_session_arguments(command, options->camera);
    });
}

}  // namespace stipple
