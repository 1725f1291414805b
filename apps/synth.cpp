#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/leftovers.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/subcommands.h"
#include "io/frame_writer.h"
#include "io/output_names.h"
#include "io/video_reader.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

struct SynthOptions {
    std::string scene;
    std::string output;
    SceneOptions rendering;
};

void synth(const SynthOptions& options, const RunOptions& run) {
    const Scene scene(scene_from_name(options.scene), options.rendering);
    const FrameShape shape = options.rendering.shape;
    JsonFile json(run);
    FrameWriter writer(options.output, shape, {.force = run.force});
    say_leftover(options.output);
    std::vector<float> frame(shape.sites());
    Progress progress(run, "rendering", options.rendering.slots);
    for (int slot = 0; slot < options.rendering.slots && stop_signal() == 0; ++slot) {
        const bool complete = scene.render(slot, frame, [&](double part) {
            progress.reach(slot + part);
            return stop_signal() == 0;
        });
        if (!complete) break;
        writer.write(frame);
        progress.reach(slot + 1);
    }
    if (progress.done() == 0) throw_if_stopped();
    writer.finish();
    const double rate = static_cast<double>(progress.done()) / progress.seconds();
    json.write({{"scene", options.scene},
                {"slots", progress.done()},
                {"rows", shape.rows},
                {"cols", shape.cols},
                {"planes", shape.planes},
                {"slots_per_second", rate}});
    run.say(fmt::format("{}: {} of {} x {}, {}, {} frames/s", options.output,
                        counted(progress.done(), "frame"), shape.cols, shape.rows,
                        is_video_name(options.output) || is_pipe(options.output)
                            ? "tone-mapped to 8 bits"
                            : "linear light",
                        rounded(rate)));
}

}  // namespace

void add_synth(Command& app, Action& action) {
    Command command = app.add_command("synth", "Render an embedded HDR scene as footage");
    const auto options = std::make_shared<SynthOptions>();
    command.add_option("SCENE", options->scene, "scene, of \"stipple list scenes\"")
        .one_of(names_of(scenes()))
        .required();
    add_output(command, options->output, "folder (EXR), .npy, .tif, .mp4, .mkv, .y4m, - (.y4m)",
               kVideoName, "OUT");
    add_scene_arguments(command, options->rendering);
    command.add_flag(
        "--luminance", [options] { options->rendering.shape.planes = 1; },
        "render Rec. 709 luminance instead of colours");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple synth pan -o scene\n"
        "  stipple synth dice -o dice.npy --frames 200 --size 640x480 --seed 7");
    set_action(command, action, options, synth);
}

}  // namespace stipple
