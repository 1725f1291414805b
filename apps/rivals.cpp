#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "apps/explore_run.h"
#include "apps/report/column_width.h"
#include "apps/report/json_file.h"
#include "apps/subcommands.h"
#include "core/config.h"
#include "core/joined.h"
#include "explore/results_table.h"

namespace stipple {
namespace {

struct RivalsArguments {
    std::string footage;
    std::string results;
    std::string space = "rivals";
    std::string sensor = {};  ///< empty: that of the space
    FootageOptions reading = {};
    int seeds = 1;
    std::vector<std::string> systems = {};  ///< empty: all
    std::string dictionary = {};            ///< empty: that of the space
};

/// A column of the table for people.
struct RivalColumn {
    const char* heading;
    double TrialFigures::*value;
    double scale;
    int digits;
};
constexpr RivalColumn kColumns[] = {{"field %", &TrialFigures::field_of_view, 100, 0},
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
                                    {"decode s", &TrialFigures::decode_seconds, 1, 1}};

/// What is compared, and what the headings leave open.
std::string legend_of(const Exploration& exploration) {
    for (const ExploredPoint& point : exploration.points())
        if (point.figures)
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

/// The system of each point; of a space without systems the values that differ.
std::vector<std::string> names_of(const Space& space) {
    std::vector<std::string> names;
    for (std::uint64_t number = 0; number < space.size(); ++number) {
        const SpacePoint point = space.point(number);
        std::vector<std::string> values;
        for (std::size_t i = 0; i < point.size(); ++i)
            if (space.systems.empty() ? space.axes[i].values.size() > 1
                                      : space.axes[i].name == "system")
                values.push_back(point[i]);
        names.push_back(joined(values));
    }
    return names;
}

bool has_interval(const RivalColumn& column) {
    return std::ranges::any_of(kFigureColumns, [&](const FigureColumn& known) {
        return known.value == column.value && has_interval(known);
    });
}

int width_of(const RivalColumn& column, const Exploration& exploration) {
    return exploration.seeds() > 1 && has_interval(column) ? 12 : 8;
}

/// "30.42", of several seeds "30.42 +-0.69".
std::string figure_text(const ExploredPoint& point, const RivalColumn& column) {
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

std::string table_of(const Exploration& exploration) {
    const std::vector<std::string> names = names_of(exploration.space());
    const std::size_t width = column_width(names, [](const std::string& name) { return name; });
    std::string text(width, ' ');
    if (exploration.seeds() > 1) text += "  rank";
    for (const RivalColumn& column : kColumns)
        text += fmt::format("  {:>{}}", column.heading, width_of(column, exploration));
    for (std::size_t number = 0; number < names.size(); ++number) {
        const ExploredPoint& point = exploration.points()[number];
        text += fmt::format("\n{:<{}}", names[number], width);
        if (exploration.seeds() > 1) text += fmt::format("  {:>4}", text_of(point.rank));
        for (const RivalColumn& column : kColumns)
            text +=
                fmt::format("  {:>{}}", figure_text(point, column), width_of(column, exploration));
        if (!point.problem.empty()) text += "  " + point.problem;
    }
    return text + legend_of(exploration) + legend_of_seeds(exploration.seeds());
}

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
    ExploreRun what{
        .space = find_config(ConfigKind::kSpaces, arguments.space).string(),
        .results = arguments.results,
        .title = "Rivals: " + std::filesystem::path(arguments.footage).filename().string(),
        .options = {}};
    what.options.reading = arguments.reading;
    what.options.seeds = arguments.seeds;
    what.options.replaced = {{"footage", {arguments.footage}}};
    if (!arguments.sensor.empty()) what.options.replaced.push_back({"sensor", {arguments.sensor}});
    if (!arguments.systems.empty()) what.options.replaced.push_back({"system", arguments.systems});
    if (!arguments.dictionary.empty())
        what.options.replaced.push_back({"decoder.dictionary", {arguments.dictionary}});
    JsonFile json(run);
    const Exploration exploration = explored(what, run);
    json.write(json_of(exploration));
    require_figures(what, exploration);
    run.say(table_of(exploration) + "\n" + counts_text(what, exploration));
}

}  // namespace

void add_rivals(Command& app, Action& action) {
    Command command =
        app.add_command("rivals", "Coded exposure and its rivals on a scene, with equal samples");
    const auto arguments = std::make_shared<RivalsArguments>();
    command
        .add_option("FOOTAGE", arguments->footage, "footage, or a scene of \"stipple list scenes\"")
        .required()
        .input();
    add_results(command, arguments->results);
    add_reading(command, arguments->reading);
    add_seeds(command, arguments->seeds);
    command
        .add_option("--sensor", arguments->sensor,
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
    command.add_list("--system", arguments->systems, "only this one; may be repeated")
        .type_name("NAME")
        .default_text("all");
    command
        .add_option("--dictionary", arguments->dictionary,
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
        "second, unless its name says otherwise, and decodes it. A system that cannot do it is a\n"
        "row with the reason (docs/rivals.md).");
    set_action(command, action, arguments, compare_rivals);
}

}  // namespace stipple
