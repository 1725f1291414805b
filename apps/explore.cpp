#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/explore_run.h"
#include "apps/output/json_file.h"
#include "apps/subcommands.h"
#include "core/config.h"

namespace stipple {
namespace {

nlohmann::ordered_json figures_of(const Exploration& exploration, bool has_budget) {
    const auto [run, known, failed] = exploration.counts();
    nlohmann::ordered_json figures{
        {"points", exploration.space().size()}, {"run", run}, {"known", known}, {"failed", failed}};
    if (exploration.seeds() > 1) figures["seeds"] = exploration.seeds();
    if (has_budget) {
        figures["rung_slots"] = exploration.rungs();
        figures["spent"] = exploration.spent();
    }
    return figures;
}

void explore(const ExploreRun& named, const RunOptions& run) {
    ExploreRun what = named;
    what.space = find_config(ConfigKind::kSpaces, named.space).string();
    JsonFile json(run);
    const Exploration exploration = explored(what, run);
    json.write(figures_of(exploration, what.options.budget.has_value()));
    require_figures(what, exploration);
    constexpr std::size_t kMostLines = 50;  // of a screen or two
    const bool few = exploration.points().size() <= kMostLines;
    run.say((few ? table_text(exploration) + "\n\n" : "") + problems_text(exploration) +
            counts_text(what, exploration));
}

void add_budget(Command& command, ExploreOptions& options) {
    command
        .add_parsed(
            "--budget",
            [&options](const std::string& text) {
                options.budget = parse_budget(text);
                if (!options.budget)
                    throw UsageError("--budget", "\"" + text +
                                                     "\" is neither a time, as 90s, 10m or 2h, nor "
                                                     "a number of decoded clips");
            },
            "most time of decoding, as 10m, or number of decoded clips: first all points with a "
            "part of the clip, then the better half with more of it")
        .default_text("the whole clip for all points")
        .type_name("AMOUNT");
    std::vector<std::string> names;
    names.reserve(kFigureColumns.size());
    for (const FigureColumn& column : kFigureColumns) names.emplace_back(column.name);
    command
        .add_option("--rank", options.rank, "column of the table that tells which half is better")
        .one_of(names)
        .default_text("rate, psnr_db and energy")
        .type_name("COLUMN");
}

}  // namespace

void add_explore(Command& app, Action& action) {
    Command command = app.add_command("explore", "A table of many sensors, schedules and decoders");
    const auto arguments = std::make_shared<ExploreRun>();
    command
        .add_option("SPACE", arguments->space,
                    "what to try: a TOML file (docs/explore.md), or one of \"stipple list spaces\"")
        .required()
        .listed("spaces")
        .input();
    add_results(command, arguments->results);
    add_reading(command, arguments->options.reading);
    add_seeds(command, arguments->options.seeds);
    add_budget(command, arguments->options);
    command.add_flag("--no-report", arguments->no_report, "leave out report.html");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple explore bit_depth -o results\n"
        "  stipple explore bit_depth -o results --budget 10m\n"
        "  stipple explore space.toml -o results --transfer srgb --luminance --crop 320x240\n"
        "A second run does only what is new. A point that cannot be run is a row with the reason;\n"
        "the exit code is 1 if no point could be run.");
    set_action(command, action, arguments, explore, [command, arguments] {
        if (!arguments->options.budget && arguments->options.seeds == 1)
            command.refuse({"--rank"},
                           "is of --budget and --seeds; add one of them or leave this out");
    });
}

}  // namespace stipple
