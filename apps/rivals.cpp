#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "apps/arguments/common_options.h"
#include "apps/explore_run.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "core/config.h"
#include "decoder/decode_method.h"
#include "study/explore/results.h"
#include "study/explore/rivals.h"

namespace stipple {
namespace {

struct RivalsArguments {
    RivalsChoice choice;
    std::string results;
    std::string space = "rivals";
    std::vector<std::string> methods = {};
    FootageOptions reading = {};
    int seeds = 1;
};

nlohmann::ordered_json json_of(const TableValue& value) {
    return std::visit(
        [](const auto& known) -> nlohmann::ordered_json {
            if constexpr (std::is_same_v<std::decay_t<decltype(known)>, std::monostate>)
                return nullptr;
            else
                return known;  // an infinite number becomes null
        },
        value);
}

nlohmann::ordered_json json_of(const Exploration& exploration) {
    auto systems = nlohmann::ordered_json::array();
    for (std::uint64_t number = 0; number < exploration.points().size(); ++number) {
        nlohmann::ordered_json entry;
        for (const auto& [column, value] : table_row(exploration, number))
            entry[column] = json_of(value);
        systems.push_back(std::move(entry));
    }
    return {{"systems", systems}};
}

void compare_rivals(const RivalsArguments& arguments, const RunOptions& run) {
    ExploreRun what{.space = find_config(ConfigKind::kSpaces, arguments.space).string(),
                    .results = arguments.results,
                    .title = arguments.choice.title(),
                    .options = {}};
    what.options.reading = arguments.reading;
    what.options.seeds = arguments.seeds;
    what.options.methods = arguments.methods;
    what.options.replaced = arguments.choice.replaced();
    JsonFile json(run);
    const Exploration exploration = explored(what, run);
    json.write(json_of(exploration));
    require_figures(what, exploration);
    run.say(table_text(exploration) + "\n\n" + problems_text(exploration) +
            counts_text(what, exploration));
}

}  // namespace

void add_rivals(Command& app, Action& action) {
    Command command =
        app.add_command("rivals", "Coded exposure and its rivals on a scene, with equal samples");
    const auto arguments = std::make_shared<RivalsArguments>();
    command
        .add_option("FOOTAGE", arguments->choice.footage,
                    "footage, or a scene of \"stipple list scenes\"")
        .required()
        .input();
    add_results(command, arguments->results);
    add_reading(command, arguments->reading);
    add_seeds(command, arguments->seeds);
    command
        .add_option("--sensor", arguments->choice.sensor,
                    "sensor of the systems, of \"stipple list sensors\"")
        .default_text("that of the space")
        .type_name("NAME|FILE")
        .listed("sensors")
        .input();
    command
        .add_option("--space", arguments->space,
                    "the systems: a name of config/spaces or a file (docs/explore.md)")
        .shows_default()
        .type_name("NAME|FILE")
        .input();
    command
        .add_list("--system", arguments->choice.systems,
                  "only this one, and its copies by --method; may be repeated")
        .type_name("NAME")
        .default_text("all");
    command
        .add_list("--method", arguments->methods,
                  "also decode by this one what has one sensor and is decoded by best, as \"coded "
                  "learned\"; may be repeated")
        .type_name("NAME")
        .one_of(names_of(decode_methods()));
    command
        .add_option("--dictionary", arguments->choice.dictionary,
                    "dictionary of hitomi2011, of \"stipple dictionary\"")
        .default_text("that of the space")
        .type_name("FILE")
        .input();
    add_threads(command, action.options);
    command.footer(
        "Example:\n"
        "  stipple rivals pan -o results\n"
        "  stipple rivals clip.mp4 -o results --transfer srgb --luminance --crop 320x240\n"
        "Each system records the footage through the same aperture with about as many samples a\n"
        "second, unless its name says otherwise, and decodes it (docs/rivals.md).");
    set_action(command, action, arguments, compare_rivals);
}

}  // namespace stipple
