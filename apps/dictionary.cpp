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
#include "core/exposure_schedule.h"
#include "session/dictionary_training.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

struct DictionaryArguments {
    std::vector<std::string> sources;
    std::string output;
    FootageOptions footage;
    DictionarySettings settings;
};

TrainingClip clip_of(const std::string& source, ReadAhead& footage) {
    return {
        .name = source, .shape = footage.shape(), .filter = footage.filter(), .next = [&footage] {
            throw_if_stopped();
            return footage.next();
        }};
}

void learn(const DictionaryArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    PendingOutput output(arguments.output, run.force);
    say_leftover(arguments.output);
    DictionaryTraining training(arguments.settings);
    for (const std::string& source : arguments.sources) {
        ReadAhead footage = read_footage(source, arguments.footage);
        training.add_clip(clip_of(source, footage));
    }
    Progress progress(run, "learning", arguments.settings.learning.iterations, "iteration");
    double last_error = 0;
    const PatchDictionary dictionary = training.learn([&](int, double error) {
        progress.advance();
        last_error = error;
        return stop_signal() == 0;
    });
    throw_if_stopped();
    write_dictionary(dictionary, output);
    auto figures = json_of([&](const auto& add) { training.visit_figures(add); });
    const auto patches = figures["patches"].get<std::size_t>();
    figures["seconds"] = progress.seconds();
    json.write(std::move(figures));
    run.say(
        fmt::format("{}: {} of {} x {} pixels and {}, from {} patches\n  error of a value  {} of "
                    "the mean light",
                    arguments.output, counted(dictionary.atoms, "atom"), dictionary.shape.side_px,
                    dictionary.shape.side_px, counted(dictionary.shape.slots, "slot"), patches,
                    rounded(last_error)));
}

void add_learning(Command& command, DictionaryArguments& arguments) {
    command
        .add_option("--slots", arguments.settings.shape.slots,
                    "slots of a patch: the schedule's period")
        .shows_default()
        .check(whole_check(1, kMaxExposureSlots))
        .type_name("N");
    command.add_option("--side", arguments.settings.shape.side_px, "rows and columns of a patch")
        .shows_default()
        .check(whole_check(2, DictionarySettings::kMaxSidePx))
        .type_name("PX");
    command.add_option("--atoms", arguments.settings.learning.atoms, "patches of the dictionary")
        .shows_default()
        .check(whole_check(2, DictionarySettings::kMaxAtoms))
        .type_name("N");
    command.add_option("--sparsity", arguments.settings.learning.sparsity, "max atoms of a patch")
        .shows_default()
        .check(whole_check(1, DictionarySettings::kMaxSparsity))
        .type_name("N");
    command
        .add_option("--iterations", arguments.settings.learning.iterations, "iterations of K-SVD")
        .shows_default()
        .check(whole_check(1, DictionarySettings::kMaxIterations))
        .type_name("N");
    command.add_option("--patches", arguments.settings.patches, "max patches to learn from")
        .shows_default()
        .check(whole_check(2, DictionarySettings::kMaxPatches))
        .type_name("N");
    add_seed(command, arguments.settings.learning.seed, "seed of the choice of patches");
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
