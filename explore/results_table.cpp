#include "explore/results_table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <span>
#include <string_view>
#include <type_traits>

#include "explore/exploration.h"

namespace stipple {
namespace {

/// As RFC 4180. A text that a spreadsheet would take for a formula has an apostrophe before it.
std::string csv_field(std::string text) {
    if (!text.empty() && std::string_view("=+-@\t\r").find(text[0]) != std::string_view::npos)
        text.insert(0, 1, '\'');
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
    return quoted + "\"";
}

std::string csv_field(const TableValue& value) {
    return std::visit(
        [](const auto& known) -> std::string {
            using Known = std::decay_t<decltype(known)>;
            if constexpr (std::is_same_v<Known, std::monostate>) return {};
            if constexpr (std::is_same_v<Known, std::string>) return csv_field(known);
            if constexpr (std::is_same_v<Known, double>) return fmt::format("{:.12g}", known);
            if constexpr (std::is_same_v<Known, int>) return std::to_string(known);
        },
        value);
}

TableValue table_value(double value) {
    return std::isnan(value) ? TableValue() : TableValue(value);
}

void add_interval(std::vector<TableCell>& row, std::string_view name,
                  std::span<const double> samples) {
    const MeanInterval interval = samples.empty() ? MeanInterval() : mean_interval(samples);
    row.push_back({fmt::format("{}_low", name), table_value(interval.low)});
    row.push_back({fmt::format("{}_high", name), table_value(interval.high)});
}

void add_names(std::string& text, const std::vector<TableCell>& row) {
    for (const TableCell& cell : row) text += csv_field(cell.column) + ",";
    text.back() = '\n';
}

void add_values(std::string& text, const std::vector<TableCell>& row) {
    for (const TableCell& cell : row) text += csv_field(cell.value) + ",";
    text.back() = '\n';
}

/// The means of a figure over the seeds, of each footage.
std::vector<double> footage_samples(const Exploration& exploration,
                                    const std::vector<std::uint64_t>& numbers,
                                    double TrialFigures::*figure) {
    std::vector<double> samples;
    samples.reserve(numbers.size());
    for (const std::uint64_t number : numbers)
        samples.push_back(exploration.points()[number].figures.value().*figure);
    return samples;
}

}  // namespace

std::vector<TableCell> table_row(const Exploration& exploration, std::uint64_t number) {
    const Space& space = exploration.space();
    const ExploredPoint& point = exploration.points()[number];
    const SpacePoint values = space.point(number);
    const TrialFigures figures = point.figures.value_or(TrialFigures());
    std::vector<TableCell> row;
    for (std::size_t i = 0; i < values.size(); ++i) row.push_back({space.axes[i].name, values[i]});
    for (const FigureColumn& column : kFigureColumns) {
        row.push_back({std::string(column.name), table_value(figures.*column.value)});
        if (exploration.seeds() > 1 && has_interval(column))
            add_interval(row, column.name, samples_of(point.trials, column.value));
    }
    for (const TextColumn& column : kTextColumns)
        row.push_back({std::string(column.name), figures.*column.value});
    if (exploration.seeds() > 1) row.push_back({"rank", text_of(point.rank)});
    row.push_back({"rung", point.figures ? TableValue(point.rung) : TableValue()});
    row.push_back({"slots", point.figures ? TableValue(point.slots) : TableValue()});
    row.push_back({"problem", point.problem});
    return row;
}

std::string csv_table(const Exploration& exploration) {
    std::string text;
    add_names(text, table_row(exploration, 0));  // there is a point, as an axis has a value
    for (std::uint64_t number = 0; number < exploration.points().size(); ++number)
        if (exploration.points()[number].touched) add_values(text, table_row(exploration, number));
    return text;
}

std::string footage_table(const Exploration& exploration) {
    const Space& space = exploration.space();
    const std::size_t footage = space.axes.front().values.size();  // the first axis
    if (footage == 1) return {};
    const int rung = exploration.last_rung();
    const std::uint64_t combinations = space.size() / footage;
    std::vector<std::vector<TableCell>> rows;
    std::vector<std::vector<double>> ranked;
    for (std::uint64_t combination = 0; combination < combinations; ++combination) {
        std::vector<std::uint64_t> numbers;
        for (std::size_t i = 0; i < footage; ++i) {
            const std::uint64_t number = i * combinations + combination;
            const ExploredPoint& point = exploration.points()[number];
            if (point.figures && point.rung == rung) numbers.push_back(number);
        }
        if (numbers.size() < footage) continue;
        const SpacePoint values = space.point(combination);
        rows.emplace_back();
        for (std::size_t i = 1; i < values.size(); ++i)
            rows.back().push_back({space.axes[i].name, values[i]});
        for (const FigureColumn& column : kFigureColumns) {
            if (!has_interval(column)) continue;
            const auto samples = footage_samples(exploration, numbers, column.value);
            rows.back().push_back({std::string(column.name), table_value(mean_of(samples))});
            add_interval(rows.back(), column.name, samples);
        }
        ranked.push_back(footage_samples(exploration, numbers, &TrialFigures::psnr_db));
    }
    const std::vector<Rank> ranks = tied_ranks(ranked);
    std::string text;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i].push_back({"rank", text_of(ranks[i])});
        if (i == 0) add_names(text, rows[i]);
        add_values(text, rows[i]);
    }
    return text;
}

}  // namespace stipple
