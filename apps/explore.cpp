#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "apps/arguments/checks.h"
#include "apps/interrupt.h"
#include "apps/report/json_file.h"
#include "apps/report/number_text.h"
#include "apps/report/own_command.h"
#include "apps/report/progress.h"
#include "apps/standard_error.h"
#include "apps/subcommands.h"
#include "core/error.h"
#include "explore/exploration.h"
#include "explore/results_page.h"
#include "report/run_report.h"

namespace stipple {
namespace {

struct ExploreArguments {
    std::string space;
    std::string results;
    ExploreOptions options;
    bool no_report = false;
};

bool keep_going() {
    return stop_signal() == 0;
}

/// A trial that cannot be run is a row with the reason. \throws TrialStopped, DeviceError.
void run_point(Exploration& exploration, std::uint64_t number) {
    const Trial* const trial = exploration.begin(number);
    if (trial == nullptr) return;
    try {
        const auto stream = exploration.store().stream_of(trial->identity);
        exploration.put(number, run_trial(*trial, exploration.light(), stream, keep_going));
    } catch (const InputError& e) {
        if (!keep_going()) throw TrialStopped();  // the signal has cut the input short
        exploration.fail(number, e.what());
    }
}

/// Until all is done, or a signal asks to stop.
void run_points(Exploration& exploration, Progress& progress) {
    try {
        while (exploration.next_rung())
            for (const std::uint64_t number : exploration.due()) {
                if (!keep_going()) return;
                run_point(exploration, number);
                progress.advance();
            }
    } catch (const TrialStopped&) {
        // What is done stays done.
    }
}

nlohmann::ordered_json figures_of(const Exploration& exploration, bool has_budget) {
    const auto [run, known, failed] = exploration.counts();
    nlohmann::ordered_json figures{
        {"points", exploration.space().size()}, {"run", run}, {"known", known}, {"failed", failed}};
    if (has_budget) {
        figures["rung_slots"] = exploration.rungs();
        figures["spent"] = exploration.spent();
    }
    return figures;
}

void explore(const ExploreArguments& arguments, const RunOptions& run) {
    JsonFile json(run);
    ExploreOptions options = arguments.options;
    options.force = run.force;
    Exploration exploration(arguments.space, arguments.results, options, keep_going);
    run.say(fmt::format("{}: {}", arguments.space, counted(exploration.space().size(), "point")));
    {
        Progress progress(run, "exploring", static_cast<std::int64_t>(exploration.most_trials()),
                          "point");
        run_points(exploration, progress);
    }
    exploration.store().write("table.csv", exploration.csv());
    if (!arguments.no_report) {
        exploration.store().write("report.html",
                                  results_page(exploration, arguments.space, own_command()));
        say_warning(chart_warning());
    }
    json.write(figures_of(exploration, options.budget.has_value()));
    const auto [trials, known, failed] = exploration.counts();
    run.say(fmt::format("{}/{}: {} run, {} known before, {} failed", arguments.results,
                        arguments.no_report ? "table.csv" : "report.html", trials, known, failed));
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
    const auto arguments = std::make_shared<ExploreArguments>();
    command.add_option("SPACE", arguments->space, "what to try, a TOML file (docs/explore.md)")
        .required()
        .input();
    command
        .add_option("-o,--output", arguments->results,
                    "folder of results; those that it has are kept")
        .type_name("RESULTS")
        .required()
        .output();
    add_budget(command, arguments->options);
    command.add_flag("--no-report", arguments->no_report, "leave out report.html");
    add_threads(command, action.options);
    command.footer(
        "Examples:\n"
        "  stipple explore config/spaces/bit_depth.toml -o results\n"
        "  stipple explore config/spaces/bit_depth.toml -o results --budget 10m\n"
        "A second run does only what is new. A point that cannot be run is a row with the reason.");
    set_action(command, action, arguments, explore, [command, arguments] {
        if (!arguments->options.budget)
            command.refuse({"--rank"}, "is of --budget; add that or leave this out");
    });
}

}  // namespace stipple
