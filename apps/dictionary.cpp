#include <fmt/format.h>

#include <memory>
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
#include "core/error.h"
#include "core/exposure_schedule.h"
#include "core/memory_limit.h"
#include "decoder/hitomi2011/ksvd.h"
#include "io/npy_file.h"
#include "io/pending_output.h"

namespace stipple {
namespace {

constexpr OutputName kDictionaryName{"a dictionary is a .npy, or has a name without extension",
                                     {".npy"}};

struct DictionaryArguments {
    std::vector<std::string> sources;
    std::string output;
    FootageOptions footage;
    AtomShape shape{.slots = 8, .side_px = 7};
    std::uint64_t patches = 20000;
    KsvdOptions learning;
};

void require_memory(const DictionaryArguments& arguments) {
    const std::uint64_t patch_bytes = 2 * arguments.shape.voxels() * sizeof(float) + 512;
    const auto atoms = static_cast<std::uint64_t>(arguments.learning.atoms);
    check_memory(arguments.patches * patch_bytes +
                     atoms * (atoms + 2 * arguments.shape.voxels()) * sizeof(float),
                 "--patches",
                 fmt::format("a dictionary of {} atoms from {} patches", atoms, arguments.patches));
}

/// Adds the patches of a clip; returns the number of its frames.
int add_clip(const std::string& source, const DictionaryArguments& arguments,
             TrainingPatches& patches) {
    ReadAhead footage = read_footage(source, arguments.footage);
    const FrameShape shape = footage.shape();
    const int side = arguments.shape.side_px;
    if (std::min(shape.rows, shape.cols) < side)
        throw InputError(source, fmt::format("its frames of {} x {} are smaller than a patch of {} "
                                             "x {} pixels; give --side, or other footage",
                                             shape.cols, shape.rows, side, side));
    if (footage.filter() != ColourFilter::kNone)
        throw InputError(source,
                         "is a mosaic of colours, whose neighbours differ; give footage of "
                         "one plane or three");
    patches.begin_clip(shape);
    int frames = 0;
    for (auto frame = footage.next(); !frame.empty(); frame = footage.next(), ++frames) {
        throw_if_stopped();
        patches.add_frame(frame);
    }
    if (frames < arguments.shape.slots)
        throw InputError(source, fmt::format("has {}, a patch {}; give --slots, or longer footage",
                                             counted(frames, "frame"), arguments.shape.slots));
    return frames;
}

void write(const PatchDictionary& dictionary, PendingOutput& output) {
    NpyWriter writer(output.partial(), output.final_path().string(),
                     {.rows = dictionary.shape.slots,
                      .cols = static_cast<int>(dictionary.shape.pixels()),
                      .planes = 1});
    for (int i = 0; i < dictionary.atoms; ++i) writer.write(dictionary.atom(i));
    writer.finish();
    output.commit();
}

void learn(const DictionaryArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(arguments.output, run.force);
    say_leftover(arguments.output);
    require_memory(arguments);
    TrainingPatches training(arguments.shape, arguments.patches, arguments.learning.seed);
    int frames = 0;
    for (const std::string& source : arguments.sources)
        frames += add_clip(source, arguments, training);
    const std::size_t count = training.patches();
    KsvdOptions learning = arguments.learning;
    if (count < static_cast<std::size_t>(learning.atoms))
        throw InputError(
            arguments.sources.front(),
            fmt::format("{} patches with contrast are too few for {} atoms; give more footage, "
                        "or --atoms",
                        count, learning.atoms));
    Progress progress(run, "learning", learning.iterations, "iteration");
    std::vector<double> errors;
    learning.keep_going = [&](int, double error) {
        progress.advance();
        errors.push_back(error);
        return stop_signal() == 0;
    };
    const std::vector<float> patches = training.take();
    const PatchDictionary dictionary = learn_dictionary(patches, arguments.shape, learning);
    throw_if_stopped();
    write(dictionary, output);
    json.write({{"atoms", dictionary.atoms},
                {"slots", dictionary.shape.slots},
                {"side", dictionary.shape.side_px},
                {"frames", frames},
                {"patches", count},
                {"errors", errors},
                {"seconds", progress.seconds()}});
    run.say(
        fmt::format("{}: {} of {} x {} pixels and {}, from {} patches\n  error of a value  {} of "
                    "the mean light",
                    arguments.output, counted(dictionary.atoms, "atom"), dictionary.shape.side_px,
                    dictionary.shape.side_px, counted(dictionary.shape.slots, "slot"), count,
                    errors.empty() ? "unknown" : rounded(errors.back())));
}

void add_learning(Command& command, DictionaryArguments& arguments) {
    command.add_option("--slots", arguments.shape.slots, "slots of a patch: the schedule's period")
        .shows_default()
        .check(whole_check(1, kMaxExposureSlots))
        .type_name("N");
    command.add_option("--side", arguments.shape.side_px, "rows and columns of a patch")
        .shows_default()
        .check(whole_check(2, 32))
        .type_name("PX");
    command.add_option("--atoms", arguments.learning.atoms, "patches of the dictionary")
        .shows_default()
        .check(whole_check(2, 16384))
        .type_name("N");
    command.add_option("--sparsity", arguments.learning.sparsity, "max atoms of a patch")
        .shows_default()
        .check(whole_check(1, 64))
        .type_name("N");
    command.add_option("--iterations", arguments.learning.iterations, "iterations of K-SVD")
        .shows_default()
        .check(whole_check(1, 1000))
        .type_name("N");
    command.add_option("--patches", arguments.patches, "max patches to learn from")
        .shows_default()
        .check(whole_check(2, 10'000'000))
        .type_name("N");
    add_seed(command, arguments.learning.seed, "seed of the choice of patches");
}

}  // namespace

void add_dictionary(Command& app, Action& action) {
    Command command = app.add_command("dictionary", "Learn patches of footage, for hitomi2011");
    const auto options = std::make_shared<DictionaryArguments>();
    command.add_option("FOOTAGE", options->sources, "footage, linear light, not that to be decoded")
        .required()
        .input();
    add_output(command, options->output, "dictionary, an array (atom, slot, pixel)",
               kDictionaryName);
    add_learning(command, *options);
    add_footage_arguments(command, options->footage);
    add_threads(command, action.options);
    command.footer(
        "Example:\n"
        "  stipple dictionary street garden -o patches.npy --slots 8\n"
        "  stipple emulate scene -o clip.stipple --schedule single_bump\n"
        "  stipple decode clip.stipple -o decoded --method hitomi2011 \\\n"
        "    --set decoder.dictionary=patches.npy\n"
        "The same footage, options and seed give the same bits.");
    set_action(command, action, options, learn);
}

}  // namespace stipple
