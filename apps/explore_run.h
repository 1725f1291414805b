#pragma once

#include <string>

#include "apps/arguments/run_options.h"
#include "study/explore/exploration.h"

namespace stipple {

struct ExploreRun {
    std::string space;    ///< file
    std::string results;  ///< folder
    std::string title;    ///< of the page; empty: the name of the file
    ExploreOptions options;
    bool no_report = false;
};

/// The option -o RESULTS.
void add_results(Command& command, std::string& results);

/// The option --seeds.
void add_seeds(Command& command, int& seeds);

/// How the footage of all points is read.
void add_reading(Command& command, FootageOptions& reading);

/// Runs all points of the space, until a signal asks to stop, and writes table.csv and report.html
/// into the results. \throws InputError, DeviceError.
[[nodiscard]] Exploration explored(const ExploreRun& what, const RunOptions& run);

/// Precondition: the results are written. \throws InputError if every point has failed, with the
/// problem of the first one.
void require_figures(const ExploreRun& what, const Exploration& exploration);

/// "results/report.html: 4 run, 0 known before, 0 failed"
[[nodiscard]] std::string counts_text(const ExploreRun& what, const Exploration& exploration);

/// The points with their figures for people, a line each, and what the figures mean.
[[nodiscard]] std::string table_text(const Exploration& exploration);

/// How many points have failed for each of the first reasons, a line each with the first of them;
/// empty if none has.
[[nodiscard]] std::string problems_text(const Exploration& exploration);

}  // namespace stipple
