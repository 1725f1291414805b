#include "apps/explore_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/output/text_layout.h"
#include "core/text.h"
#include "study/explore/exploration.h"

namespace stipple {
namespace {

/// A column, in the units that people read.
struct ShownColumn {
    const char* heading;
    double TrialFigures::*value;
    double scale;
    int digits;
};
constexpr ShownColumn kColumns[] = {{"field %", &TrialFigures::field_of_view, 100, 0},
                                    {"samples", &TrialFigures::samples_per_voxel, 1, 3},
                                    {"light %", &TrialFigures::light_throughput, 100, 0},
                                    {"stops", &TrialFigures::sample_range_stops, 1, 1},
                                    {"PSNR dB", &TrialFigures::psnr_db, 1, 2},
                                    {"gamma dB", &TrialFigures::psnr_gamma_db, 1, 2},
                                    {"PU21 dB", &TrialFigures::pu21_psnr_db, 1, 2},
                                    {"slots/s", &TrialFigures::readout_slots_per_second, 1, 0},
                                    {"Mbit/s", &TrialFigures::megabits_per_second, 1, 0},
                                    {"code", &TrialFigures::code_megabits_per_second, 1, 0},
                                    {"uJ/slot", &TrialFigures::energy_uj_per_slot, 1, 0},
                                    {"decode s", &TrialFigures::decode_seconds, 1, 1},
                                    {"MB", &TrialFigures::decode_megabytes, 1, 0}};

/// What is compared, and what the headings leave open.
std::string legend_of(const Exploration& exploration) {
    for (const ExploredPoint& point : exploration.points())
        if (point.figures && point.rung == exploration.last_rung())
            return fmt::format(
                "\n\ncompared: slots {} (first:end) of {}, light up to {}\n"
                "samples: per voxel of the clip; stops: range of the samples; slots/s: the most "
                "of the readout;\nMbit/s of samples and of exposure code: at the slot rate of the "
                "sensor, or this one if it is less",
                point.figures->compared_slots, point.slots, kBrightestLight);
    return {};
}

/// What seeds add to it.
std::string legend_of_seeds(int seeds) {
    if (seeds == 1) return {};
    return fmt::format(
        "\nmeans of {} seeds, +- half of the 95 % interval; rank: by PSNR, = where the paired\n"
        "differences do not tell which is better",
        seeds);
}

/// The system of each point and the other values that differ.
std::vector<std::string> names_of(const Space& space) {
    std::vector<std::string> names;
    for (std::uint64_t number = 0; number < space.size(); ++number) {
        const SpacePoint point = space.point(number);
        std::vector<std::string> values;
        for (std::size_t i = 0; i < point.size(); ++i)
            if (space.axes[i].name == "system" || space.axes[i].values.size() > 1)
                values.push_back(point[i]);
        names.push_back(joined(values));
    }
    return names;
}

bool has_interval(const ShownColumn& column) {
    return std::ranges::any_of(kFigureColumns, [&](const FigureColumn& known) {
        return known.value == column.value && has_interval(known);
    });
}

int width_of(const ShownColumn& column, const Exploration& exploration) {
    return exploration.seeds() > 1 && has_interval(column) ? 12 : 8;
}

/// "30.42", of several seeds "30.42 +-0.69".
std::string figure_text(const ExploredPoint& point, const ShownColumn& column) {
    if (!point.figures) return "-";
    const double value = point.figures.value().*column.value;
    if (std::isnan(value)) return "-";
    std::string text = fmt::format("{:.{}f}", column.scale * value, column.digits);
    if (point.trials.size() == 1 || !has_interval(column)) return text;
    const MeanInterval interval = mean_interval(samples_of(point.trials, column.value));
    if (!std::isnan(interval.low))
        text += fmt::format(" +-{:.{}f}", (interval.high - interval.low) / 2, column.digits);
    return text;
}

}  // namespace

std::string table_text(const Exploration& exploration) {
    const std::vector<std::string> names = names_of(exploration.space());
    const std::size_t width = column_width(names, [](const std::string& name) { return name; });
    std::string text(width, ' ');
    if (exploration.seeds() > 1) text += "  rank";
    for (const ShownColumn& column : kColumns)
        text += fmt::format("  {:>{}}", column.heading, width_of(column, exploration));
    for (std::size_t number = 0; number < names.size(); ++number) {
        const ExploredPoint& point = exploration.points()[number];
        text += fmt::format("\n{:<{}}", names[number], width);
        if (point.figures && point.rung < exploration.last_rung()) {
            text += fmt::format("  dropped after {}", counted(point.slots, "slot"));
            continue;
        }
        if (exploration.seeds() > 1) text += fmt::format("  {:>4}", text_of(point.rank));
        for (const ShownColumn& column : kColumns)
            text +=
                fmt::format("  {:>{}}", figure_text(point, column), width_of(column, exploration));
    }
    return text + legend_of(exploration) + legend_of_seeds(exploration.seeds());
}

std::string problems_text(const Exploration& exploration) {
    constexpr std::size_t kShown = 8;
    struct Problem {
        std::string text;
        std::size_t first = 0;  // point
        int points = 1;
    };
    std::vector<Problem> problems;
    for (std::size_t number = 0; number < exploration.points().size(); ++number) {
        const std::string& problem = exploration.points()[number].problem;
        if (problem.empty()) continue;
        const auto known = std::ranges::find(problems, problem, &Problem::text);
        if (known == problems.end())
            problems.push_back({problem, number});
        else
            ++known->points;
    }
    const std::vector<std::string> names = names_of(exploration.space());
    std::string text;
    for (std::size_t i = 0; i < std::min(problems.size(), kShown); ++i)
        text += fmt::format("{} failed, {}\"{}\": {}\n", counted(problems[i].points, "point"),
                            problems[i].points > 1 ? "first " : "", names[problems[i].first],
                            problems[i].text);
    if (problems.size() > kShown)
        text += fmt::format("{} more in the column \"problem\" of table.csv\n",
                            counted(problems.size() - kShown, "reason"));
    return text;
}

}  // namespace stipple
