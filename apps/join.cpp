#include <fmt/format.h>

#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/video_output.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "io/frame_writer.h"
#include "io/npy_file.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "session/stream_shards.h"
#include "session/video_shards.h"

namespace stipple {
namespace {

struct JoinArguments {
    std::string folder;
    std::string output;
    VideoCoding video;   ///< of .mp4 and .mkv
    ImageCoding images;  ///< of folders and .tif
};

void join_stream(const JoinArguments& arguments, const RunOptions& run) {
    const StreamShards folder(arguments.folder);
    folder.require_all();
    JsonFile json(run);
    say_leftover(arguments.output);
    PendingOutput output(arguments.output, run.force);
    Progress progress(run, "joining", folder.slots(), "slot");
    const auto packets = join_pieces(folder, output, [&](double slots) {
        progress.reach(slots);
        return stop_signal() == 0;
    });
    if (!packets) throw_if_stopped();
    const std::int64_t pieces = folder.pieces().count;
    json.write({{"slots", folder.slots()}, {"pieces", pieces}, {"packets", packets.value()}});
    run.say(fmt::format("{}: {} of {}", arguments.output, counted(folder.slots(), "slot"),
                        counted(pieces, "piece")));
}

void join_video(const JoinArguments& arguments, const RunOptions& run) {
    const VideoShards folder(arguments.folder);
    folder.require_all();
    const DecodingIdentity& identity = folder.identity();
    JsonFile json(run);
    FrameWriterOptions options{
        .video = arguments.video, .images = arguments.images, .force = run.force};
    options.images.slot_s = identity.slot_us * 1e-6;
    say_leftover(arguments.output);
    FrameWriter writer(arguments.output, identity.shape, options);
    Progress progress(run, "joining", identity.slots);
    std::vector<float> frame(identity.shape.sites());
    for (std::int64_t number = 0; number < folder.count(); ++number) {
        NpyReader window(folder.window(number));
        while (window.read(frame)) {
            throw_if_stopped();
            writer.write(frame);
            progress.advance();
        }
    }
    writer.finish();
    json.write({{"slots", identity.slots},
                {"windows", folder.count()},
                {"rows", identity.shape.rows},
                {"cols", identity.shape.cols},
                {"planes", identity.shape.planes}});
    run.say(fmt::format("{}: {} of {}", arguments.output, counted(identity.slots, "frame"),
                        counted(folder.count(), "window")));
}

void join(const JoinArguments& arguments, const RunOptions& run) {
    if (is_stream_shards(arguments.folder))
        join_stream(arguments, run);
    else
        join_video(arguments, run);
}

}  // namespace

void add_join(Command& app, Action& action) {
    Command command = app.add_command(
        "join",
        "Windows of \"decode --part\" to one video, pieces of \"emulate --part\" to a stream");
    const auto options = std::make_shared<JoinArguments>();
    command
        .add_option(
            "FOLDER", options->folder,
            "folder that \"stipple decode --part\" or \"stipple emulate --part\" has filled")
        .required()
        .input();
    add_output(command, options->output,
               "folder of images, .npy, .tif (linear), .mp4, .mkv, .y4m (video), - (.y4m); of "
               "pieces a .stipple",
               {.may_be_pipe = true}, "OUT");
    add_video_arguments(command, options->video, options->images);
    command.footer(
        "Example:\n"
        "  stipple decode film.stipple -o windows --part 1/2\n"
        "  stipple decode film.stipple -o windows --part 2/2\n"
        "  stipple join windows -o film.npy\n"
        "The video has the same bytes as that of one run of \"stipple decode\".\n"
        "  stipple emulate film.npy -o pieces --part 1/2\n"
        "  stipple emulate film.npy -o pieces --part 2/2\n"
        "  stipple join pieces -o film.stipple\n"
        "The stream has the same bytes as that of one run of \"stipple emulate\".");
    set_action(command, action, options, join, [command, options] {
        const bool stream = is_stream_shards(options->folder);
        check_extension("--output", options->output, stream ? kStreamName : kVideoName);
        if (stream)
            command.refuse({"--video", "--codec", "--fps", "--cd-per-unit", "--peak-cd", "--images",
                            "--samples", "--full-scale", "--pixel-um"},
                           "is of videos, and these pieces make a stream; leave it out");
        else
            check_video_arguments(command, options->video, options->images, options->output);
    });
}

}  // namespace stipple
