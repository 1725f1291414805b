#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/arguments/video_output.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/leftovers.h"
#include "apps/report/number_text.h"
#include "apps/report/progress.h"
#include "apps/subcommands.h"
#include "apps/window_folder.h"
#include "core/error.h"
#include "io/frame_writer.h"
#include "io/npy_reader.h"
#include "io/output_names.h"

namespace stipple {
namespace {

struct JoinArguments {
    std::string folder;
    std::string output;
    VideoCoding video;   ///< of .mp4 and .mkv
    ImageCoding images;  ///< of folders and .tif
};

/// \throws InputError naming the windows that are missing.
void require_all(const WindowFolder& folder, const std::string& name) {
    constexpr std::size_t kMaxNamed = 8;
    const std::vector<std::int64_t> missing = folder.missing(0, folder.count());
    if (missing.empty()) return;
    std::string names;
    for (std::size_t i = 0; i < std::min(missing.size(), kMaxNamed); ++i)
        names +=
            fmt::format("{}{}", i == 0 ? "" : ", ", folder.window(missing[i]).filename().string());
    if (missing.size() > kMaxNamed)
        names += fmt::format(" and {} more", missing.size() - kMaxNamed);
    throw InputError(name,
                     fmt::format("lacks {} of its {} windows: {}; run `stipple decode --part` "
                                 "again, which keeps the others",
                                 missing.size(), folder.count(), names));
}

void join(const JoinArguments& arguments, const RunOptions& run) {
    const WindowFolder folder(arguments.folder);
    require_all(folder, arguments.folder);
    const WindowIdentity& identity = folder.identity();
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

}  // namespace

void add_join(Command& app, Action& action) {
    Command command = app.add_command("join", "Windows of \"decode --part\" to one video");
    const auto options = std::make_shared<JoinArguments>();
    command
        .add_option("FOLDER", options->folder, "folder that \"stipple decode --part\" has filled")
        .required()
        .input();
    command
        .add_option("-o,--output", options->output,
                    "folder of images, .npy or .tif (linear), .mp4 or .mkv (video)")
        .type_name("OUT")
        .required()
        .output(kVideoName);
    add_video_arguments(command, options->video, options->images);
    command.footer(
        "Example:\n"
        "  stipple decode film.stipple -o windows --part 1/2\n"
        "  stipple decode film.stipple -o windows --part 2/2\n"
        "  stipple join windows -o film.npy\n"
        "The video has the same bytes as that of one run of \"stipple decode\".");
    set_action(command, action, options, join, [command, options] {
        check_video_arguments(command, options->video, options->images, options->output);
    });
}

}  // namespace stipple
