#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "apps/arguments/camera.h"
#include "apps/arguments/common_options.h"
#include "apps/arguments/settings.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/session_report.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "apps/subcommands.h"
#include "capture/capture_end.h"
#include "capture/open_camera.h"
#include "capture/recording/camera_recorder.h"
#include "capture/recording/coded_recorder.h"
#include "capture/recording/frame_recording.h"
#include "io/output_names.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

struct RecordArguments {
    CameraArguments camera;
    SessionOptions session;
    std::string output;  ///< file, or a folder in which a file named by the time is made
    CaptureLimits limits;
    bool fails_on_loss = false;
    bool coded = false;  ///< the samples of a camera of `capture serve --mode coded`
};

/// `output`, or a file in it that is named by the time.
std::filesystem::path file_for(const std::string& output) {
    const std::filesystem::path path(output);
    return std::filesystem::is_directory(path) ? path / recording_name_now() : path;
}

nlohmann::ordered_json recording_json(const std::string& file, const CameraRecording& recording) {
    return {{"file", file},
            {"frames", recording.end.frames},
            {"incomplete", recording.end.incomplete},
            {"repeated", recording.session.repeated},
            {"lost", lost_json(recording.session)},
            {"missing_before_first", recording.session.missing_before_first},
            {"outages", recording.session.outages},
            {"transport", transport_json(recording.transport)},
            {"payload_bytes", recording.end.payload_bytes},
            {"seconds", recording.seconds},
            {"frames_hz", or_null(recording.frames_hz)}};
}

std::string recording_text(const std::string& file, const CameraRecording& recording) {
    const auto& hz = recording.frames_hz;
    std::string text =
        fmt::format("{}: {}{}, {:.1f} MB", file, counted(recording.end.frames, "frame"),
                    hz ? fmt::format(", {:.1f} per second", *hz) : "",
                    static_cast<double>(recording.end.payload_bytes) * 1e-6);
    if (recording.end.incomplete > 0)
        text += fmt::format(", {} incomplete", recording.end.incomplete);
    if (recording.session.repeated > 0)
        text += fmt::format(", {} repeated and left out", recording.session.repeated);
    text += fmt::format("\nlost: {}", lost_text(recording.session));
    if (const std::uint64_t missing = recording.session.missing_before_first; missing > 0)
        text += fmt::format(", of these {} before the first frame", missing);
    return text;
}

/// \throws the fault that ended a recording too early, after a message on the frames kept.
void check_end(const CameraRecording& recording, const std::string& file,
               const std::string& address) {
    if (!recording.kept) throw_if_stopped();
    const auto& lost = recording.lost;
    if (recording.kept && (recording.failure || (lost && (lost->bad_file || !lost->at_end))))
        report_kept(file.c_str(), [&] { return counted(recording.end.frames, "frame"); });
    throw_early_end(recording, address);
}

void record_camera(const RecordArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    const CameraSettings settings = camera_settings(arguments.camera);
    const std::string& address = arguments.camera.address;
    CameraRecorder recorder(image_camera_opener(arguments.camera), settings,
                            file_for(arguments.output),
                            {.session = session_options(address, arguments.session),
                             .limits = arguments.limits,
                             .force = run.force,
                             .tell = say_event});
    say_warnings(recorder.description());
    say_leftover(recorder.file());
    const std::string file = recorder.file().string();  // afterwards there may be no memory for it
    const CameraRecording recording = [&] {
        Progress progress(run, "recording", arguments.limits.total());
        return recorder.record([&](std::uint64_t frames, const SessionTotals& totals) {
            progress.reach(static_cast<double>(frames));
            progress.note(losses_text(totals));
            return stop_signal() == 0;
        });
    }();
    check_end(recording, file, address);
    json.write(recording_json(file, recording));
    run.say(recording_text(file, recording));
    if (arguments.fails_on_loss) throw_if_lost(losses_text(recording.session), file);
}

void record_coded_stream(const RecordArguments& arguments, const RunOptions& run) {
    const std::string& address = arguments.camera.address;
    auto camera = interruptible(
        [address, settings = camera_settings(arguments.camera),
         buffers = arguments.camera.buffers] { return open_camera(address, settings, buffers); });
    JsonFile json(run);
    CodedRecorder recorder(std::move(camera), arguments.output, run.force, arguments.limits);
    say_leftover(arguments.output);
    const CodedRecording recording = [&] {
        Progress progress(run, "recording", recorder.slots());
        return recorder.record([&](const CodedRecording& now) {
            progress.reach(static_cast<double>(now.slots));
            if (now.missing_slots > 0) progress.note(fmt::format("{} missing", now.missing_slots));
            return stop_signal() == 0;
        });
    }();
    if ((recording.failure || recording.lost) && recording.kept)
        report_kept(arguments.output.c_str());
    if (!recording.failure && !recording.lost && !recording.kept) throw_if_stopped();
    throw_early_end(recording, address);
    json.write({{"slots", recording.slots},
                {"missing_slots", recording.missing_slots},
                {"damaged_frames", recording.damaged_frames}});
    const std::string losses = fmt::format("{} missing, {} damaged", recording.missing_slots,
                                           counted(recording.damaged_frames, "frame"));
    run.say(fmt::format("{}: {}, of these {}", arguments.output, counted(recording.slots, "slot"),
                        losses));
    if (arguments.fails_on_loss && recording.missing_slots + recording.damaged_frames > 0)
        throw_if_lost(losses, arguments.output);
}

void record(const RecordArguments& arguments, const RunOptions& run) {
    arguments.coded ? record_coded_stream(arguments, run) : record_camera(arguments, run);
}

}  // namespace

void add_capture_record(Command& capture, Action& action) {
    Command command = capture.add_command("record", "A camera to a recording");
    const auto options = std::make_shared<RecordArguments>();
    add_camera_arguments(command, options->camera);
    add_settings(command, {{"camera", &options->camera.settings}},
                 "set a feature or control of the camera, after those of --config");
    add_output(command, options->output,
               "recording, or a folder for a recording that is named after the time", {},
               "FILE|DIR");
    add_capture_limits(command, options->limits);
    add_incomplete_argument(command, options->session.incomplete);
    add_session_arguments(command, options->session);
    add_loss_argument(command, options->fails_on_loss);
    auto coded_flag = command.add_flag(
        "--coded", options->coded,
        "record the coded stream of \"capture serve --mode coded\" as \"emulate\" writes it");
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
