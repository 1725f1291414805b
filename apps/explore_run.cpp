#include "apps/explore_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/arguments/command_line.h"
#include "apps/arguments/common_options.h"
#include "apps/arguments/footage.h"
#include "apps/interrupt.h"
#include "apps/output/own_command.h"
#include "apps/output/progress.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/error.h"
#include "study/explore/results.h"
#include "study/report/run_report.h"

namespace stipple {
namespace {

bool keep_going() {
    return stop_signal() == 0;
}

/// A trial that cannot be run is a row with the reason. \throws TrialStopped, DeviceError.
void run_point(Exploration& exploration, std::uint64_t number, Progress& progress) {
    const Trial* const trial = exploration.begin(number);
    for (const Message& warning : exploration.take_warnings()) say_warning(warning);
    const double work = exploration.work_of(number);
    if (trial == nullptr) return progress.skip(work);
    const double before = progress.work_done();
    progress.note("now " + exploration.name_of(number));
    try {
        const auto stream = exploration.store().stream_of(trial->identity);
        exploration.put(
            number, run_trial(*trial, exploration.light(), stream, keep_going, [&](double part) {
                progress.reach(before + part * work, progress.done());
            }));
    } catch (const InputError& e) {
        if (!keep_going()) throw TrialStopped();  // the signal has cut the input short
        exploration.fail(number, e.message());
    }
    progress.reach(before + work, progress.done() + 1);
}

/// Of the present rung and, with half of its points each, the later ones.
double work_of_rungs(const Exploration& exploration) {
    double work = 0;
    for (const std::uint64_t number : exploration.due()) work += exploration.work_of(number);
    double all = 0;
    for (const int slots : exploration.rungs()) {
        if (slots < exploration.slots()) continue;
        all += work * slots / exploration.slots();
        work /= 2;
    }
    return all;
}

/// Until all is done, or a signal asks to stop.
void run_points(Exploration& exploration, Progress& progress) {
    try {
        while (exploration.next_rung()) {
            progress.set_work(progress.work_done() + work_of_rungs(exploration));
            for (const std::uint64_t number : exploration.due()) {
                if (!keep_going()) return;
                run_point(exploration, number, progress);
            }
        }
    } catch (const TrialStopped&) {
        // What is done stays done.
    }
}

std::string page_title(const ExploreRun& what) {
    return what.title.empty() ? std::filesystem::path(what.space).filename().string() : what.title;
}

}  // namespace

void add_results(Command& command, std::string& results) {
    add_output(command, results, "folder of results; those that it has are kept", {}, "RESULTS");
}

void add_seeds(Command& command, int& seeds) {
    constexpr int kMaxSeeds = 1000;
    command
        .add_option("--seeds", seeds,
                    "trials of each point, with its seed of noise and schedule and those after it: "
                    "means, intervals and tied ranks")
        .type_name("N")
        .check(whole_check(1, kMaxSeeds))
        .shows_default();
}

void add_reading(Command& command, FootageOptions& reading) {
    add_footage_arguments(command, reading);
    add_part_arguments(command, reading);
}

Exploration explored(const ExploreRun& what, const RunOptions& run) {
    ExploreOptions options = what.options;
    options.wording = in_options;
    options.force = run.force;
    Exploration exploration(what.space, what.results, options, keep_going);
    run.say(fmt::format("{}: {}", what.space, counted(exploration.space().size(), "point")));
    {
        Progress progress(run, "exploring", static_cast<std::int64_t>(exploration.most_trials()),
                          "trial");
        run_points(exploration, progress);
    }
    exploration.rank_points();
    write_tables(exploration);
    if (!what.no_report) {
        exploration.store().write("report.html",
                                  results_page(exploration, page_title(what), own_command()));
        say_warning(chart_warning());
    }
    return exploration;
}

void require_figures(const ExploreRun& what, const Exploration& exploration) {
    const std::vector<ExploredPoint>& points = exploration.points();
    const bool none = std::ranges::all_of(points, [](const ExploredPoint& point) {
        return !point.problem.empty() && !point.figures;
    });
    if (none)
        throw InputError(what.results + "/table.csv",
                         "no point could be run; the first: " + points.front().problem);
}

std::string counts_text(const ExploreRun& what, const Exploration& exploration) {
    const auto [trials, known, failed] = exploration.counts();
    return fmt::format("{}/{}: {} run, {} known before, {} failed", what.results,
                       what.no_report ? "table.csv" : "report.html", trials, known, failed);
}

}  // namespace stipple
