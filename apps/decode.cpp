#include <cstdint>
#include <memory>
#include <string>

#include "apps/arguments/common_options.h"
#include "apps/arguments/settings.h"
#include "apps/arguments/video_output.h"
#include "apps/decode.h"
#include "apps/subcommands.h"
#include "decoder/reconstruct.h"
#include "io/output_names.h"
#include "session/rig_folder.h"

namespace stipple {
namespace {

/// Options on the part of the stream that is decoded, and on its faults.
void add_reading(Command& command, DecodeArguments& arguments, std::string& check_schedule) {
    command.add_flag("--strict", arguments.strict, "write nothing if the stream is damaged");
    command.add_flag("--fill-gaps", arguments.fill_gaps,
                     "decode missing slots even if they are most of the stream");
    command
        .add_option("--until", arguments.until,
                    "end after the first N frames; they have the same bits as in the whole stream")
        .default_text("all")
        .check(frames_check())
        .type_name("N");
    command.add_flag("--follow", arguments.follow,
                     "decode a stream that is still being written, until its end marker");
    command
        .add_option("--timeout", arguments.timeout_s,
                    "with --follow: end when nothing has been appended for this time")
        .shows_default()
        .check(number_check(0, 1e6))
        .type_name("SECONDS");
    command
        .add_flag("--check-schedule", check_schedule,
                  "first test whether the samples follow the schedule in the header, or a shift "
                  "of it; =fix decodes with the shift")
        .type_name("[=fix]")
        .one_of({"true", "fix"});
}

/// The method and its options.
void add_method(Command& command, DecodeArguments& arguments) {
    command.add_option("--method", arguments.method, "decoding method")
        .shows_default()
        .one_of(names_of(decode_methods()))
        .type_name("NAME");
    command
        .add_option("--options", arguments.options,
                    "options of the method, a TOML file (stipple list keys decoder)")
        .type_name("FILE")
        .input();
    add_settings(command, {{"decoder", &arguments.settings}}, "change one option of the method");
}

/// Windows are .npy files, and "join" makes what else is wanted of them.
void check_part(const Command& command, const DecodeArguments& arguments) {
    command.refuse({"--until", "--follow", "--stages", "--check-schedule"},
                   "has no effect on a part; leave out one of them");
    command.refuse({"--video", "--codec", "--fps", "--cd-per-unit", "--peak-cd", "--images",
                    "--samples", "--full-scale", "--pixel-um"},
                   "is an option of \"stipple join\", which makes the video of all parts");
    check_part_folder(arguments.output);
}

/// The streams of a rig are decoded as they lie in its folder.
void check_rig(const Command& command) {
    command.refuse({"--part", "--follow", "--calibration", "--check-schedule", "--stages"},
                   "is an option for one stream, but this is the folder of a rig; leave it out, or "
                   "decode one of its streams");
}

void decode_all_or_part(const DecodeArguments& arguments, const RunOptions& run) {
    if (arguments.part.count > 0)
        decode_part(arguments, run);
    else
        decode_file(arguments, run);
}

}  // namespace

void add_decode(Command& app, Action& action) {
    Command command = app.add_command("decode", "Sample stream to high-speed video");
    const auto options = std::make_shared<DecodeArguments>();
    command.add_option("STREAM", options->stream, "sample stream, or the folder of a rig")
        .required()
        .input();
    add_output(command, options->output,
               "folder of images, .npy, .tif (linear), .mp4, .mkv, .y4m (video), - (.y4m)",
               kVideoName, "OUT");
    add_method(command, *options);
    command
        .add_option(
            "--stages", options->stages,
            "keep the estimate of each stage of portz2013 or reddy2011 as DIR/start.npy and "
            "the like; of portz2013 draw DIR/convergence.png")
        .type_name("DIR")
        .output();
    command
        .add_option("--calibration", options->calibration,
                    "calibration of the chip, which \"stipple calibrate\" wrote; none: do not "
                    "calibrate")
        .default_text("NAME.stcal beside a stream NAME.stipple, if it is there")
        .type_name("FILE")
        .input();
    const auto check_schedule = std::make_shared<std::string>();
    add_reading(command, *options, *check_schedule);
    add_part(command, options->part,
             "decode part I of N into windows of the folder OUT; those that are there are kept "
             "(docs/scaling.md)");
    add_video_arguments(command, options->video, options->images);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple decode clip.stipple -o decoded\n"
        "  stipple decode clip.stipple -o decoded.mp4 --method naive --threads 1\n"
        "  stipple decode clip.stipple -o preview --method fast --until 60\n"
        "  stipple decode clip.stipple -o clean --calibration chip.stcal\n"
        "  stipple decode live.stipple -o live --method fast --follow\n"
        "  stipple decode tocci -o hdr.npy\n"
        "  stipple decode clip.stipple -o hdr.mkv --video pq --peak-cd 4000 --fps 60\n"
        "  stipple decode clip.stipple -o - | ffmpeg -i - -c:v prores clip.mov\n"
        "  stipple decode film.stipple -o windows --part 3/16\n"
        "What is intact of a damaged stream is decoded, the damage is listed, the exit code is 1.");
    set_action(command, action, options, decode_all_or_part, [command, options, check_schedule] {
        if (!check_schedule->empty())
            options->check_schedule =
                *check_schedule == "fix" ? CheckSchedule::kFixShift : CheckSchedule::kRefuseShift;
        if (is_rig_folder(options->stream)) check_rig(command);
        if (!options->follow)
            command.refuse({"--timeout"}, "needs --follow; add it, or leave this out");
        if (options->part.count > 0)
            check_part(command, *options);
        else
            check_video_arguments(command, options->video, options->images, options->output);
    });
}

}  // namespace stipple
