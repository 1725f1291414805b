#include "apps/arguments/camera.h"
#include "apps/arguments/output_names.h"
#include "apps/arguments/settings.h"
#include "apps/camera_recording.h"
#include "apps/coded_recording.h"
#include "apps/subcommands.h"

namespace stipple {
namespace {

void record(const CameraRecordingArguments& arguments, const RunOptions& run) {
    arguments.coded ? record_coded_stream(arguments, run) : record_camera(arguments, run);
}

}  // namespace

void add_capture_record(Command& capture, Action& action) {
    Command command = capture.add_command("record", "Record a camera, every frame accounted for");
    const auto options = std::make_shared<CameraRecordingArguments>();
    add_camera_arguments(command, options->camera);
    add_settings(command, {{"camera", &options->camera.settings}},
                 "set a feature or control of the camera, over --config");
    command
        .add_option("-o,--output", options->output,
                    "recording, or a folder for one that is named by the time")
        .type_name("FILE|DIR")
        .required()
        .output();
    add_capture_limits(command, options->limits);
    add_incomplete_argument(command, options->session.incomplete);
    add_session_arguments(command, options->session);
    auto coded_flag = command.add_flag(
        "--coded", options->coded,
        "the samples of a camera of \"capture serve --mode coded\", as \"emulate\" writes them");
    for (const char* option : {"--incomplete", "--stall", "--no-reconnect"})
        coded_flag.excludes(command.option(option));
    command.footer(
        "Examples:\n"
        "  stipple capture record gige:192.168.0.5 -o clip.strec --seconds 10\n"
        "  stipple capture record gige:192.168.0.5 -o clip.strec --config camera.toml \\\n"
        "      --set camera.PixelFormat=Mono12p --set camera.ExposureTime=2000");
    set_action(command, action, options, record, [command, options] {
        check_session_arguments(command, options->camera);
        check_extension("--output", options->output, options->coded ? kStreamName : kRecordingName);
    });
}

}  // namespace stipple
