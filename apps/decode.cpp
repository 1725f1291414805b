#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <string>

#include "apps/arguments/checks.h"
#include "apps/arguments/output_names.h"
#include "apps/arguments/settings.h"
#include "apps/arguments/video_output.h"
#include "apps/decode_file.h"
#include "apps/subcommands.h"
#include "core/joined.h"
#include "decoder/reconstruct.h"

namespace stipple {
namespace {

std::string method_help() {
    return fmt::format("{} ({})", joined(names_of(decode_methods())), DecodeArguments{}.method);
}

}  // namespace

void add_decode(Command& app, Action& action) {
    Command command = app.add_command("decode", "Sample stream to high-speed video");
    const auto options = std::make_shared<DecodeArguments>();
    command.add_option("STREAM", options->stream, "sample stream").required().input();
    command
        .add_option("-o,--output", options->output,
                    "folder of images, .npy or .tif (linear), .mp4 or .mkv (video)")
        .type_name("OUT")
        .required()
        .output(kVideoName);
    command.add_option("--method", options->method, method_help())
        .one_of(names_of(decode_methods()))
        .type_name("NAME");
    command
        .add_option("--options", options->options,
                    "options of the method: a file as docs/decoder_options.md says")
        .type_name("FILE")
        .input();
    add_settings(command, {{"decoder", &options->settings}}, "change one option of the method");
    command
        .add_option("--stages", options->stages,
                    "keep the estimate of each stage as .npy, and a chart of the convergence")
        .type_name("DIR")
        .output();
    command.add_flag("--strict", options->strict, "write nothing if the stream is damaged");
    command.add_flag("--fill-gaps", options->fill_gaps,
                     "decode missing slots even if they are most of the stream");
    command.add_option("--until", options->until, "stop after the first N frames")
        .check(whole_check(std::int64_t{1}, std::int64_t{1} << 53U))
        .type_name("N");
    command.add_flag("--follow", options->follow,
                     "the stream is still being written: wait for more until its end marker");
    command
        .add_option("--timeout", options->timeout_s,
                    "with --follow: end where nothing more has come for so long (10)")
        .check(number_check(0, 1e6))
        .type_name("SECONDS");
    command
        .add_flag("--check-schedule", options->check_schedule,
                  "first see whether the samples follow the schedule, or which shift of it; "
                  "=fix goes on with that shift")
        .type_name("[=fix]")
        .one_of({"true", "fix"});
    add_video_arguments(command, options->video, options->images);
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple decode clip.stipple -o decoded\n"
        "  stipple decode clip.stipple -o decoded.mp4 --method naive --threads 1\n"
        "  stipple decode clip.stipple -o preview --method fast --until 60\n"
        "  stipple decode live.stipple -o live --method fast --follow\n"
        "  stipple decode clip.stipple -o hdr.mkv --video pq --peak-cd 4000 --fps 60\n"
        "What is intact of a damaged stream is decoded, the damage is listed, the exit code is 1.");
    set_action(command, action, options, decode_file, [command, options] {
        if (!options->follow)
            command.refuse({"--timeout"}, "is of --follow; add that or leave this out");
        check_video_arguments(command, options->video, options->images, options->output);
    });
}

}  // namespace stipple
