#include "explore/results_table.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "explore/exploration.h"

namespace stipple {
namespace {

std::string csv_field(const std::string& text) {
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

}  // namespace

std::vector<TableCell> table_row(const Exploration& exploration, std::uint64_t number) {
    const Space& space = exploration.space();
    const ExploredPoint& point = exploration.points()[number];
    const SpacePoint values = space.point(number);
    const TrialFigures figures = point.figures.value_or(TrialFigures());
    std::vector<TableCell> row;
    for (std::size_t i = 0; i < values.size(); ++i) row.push_back({space.axes[i].name, values[i]});
    for (const FigureColumn& column : kFigureColumns) {
        const double value = figures.*column.value;
        row.push_back(
            {std::string(column.name), std::isnan(value) ? TableValue() : TableValue(value)});
    }
    for (const TextColumn& column : kTextColumns)
        row.push_back({std::string(column.name), figures.*column.value});
    row.push_back({"rung", point.figures ? TableValue(point.rung) : TableValue()});
    row.push_back({"slots", point.figures ? TableValue(point.slots) : TableValue()});
    row.push_back({"problem", point.problem});
    return row;
}

std::string csv_table(const Exploration& exploration) {
    std::string text;
    const auto add = [&](const std::vector<TableCell>& row, const auto& field) {
        for (const TableCell& cell : row) text += csv_field(field(cell)) + ",";
        text.back() = '\n';
    };
    // There is a point, as an axis has a value.
    add(table_row(exploration, 0), [](const TableCell& cell) { return cell.column; });
    for (std::uint64_t number = 0; number < exploration.points().size(); ++number)
        if (exploration.points()[number].touched)
            add(table_row(exploration, number), [](const TableCell& cell) { return cell.value; });
    return text;
}

}  // namespace stipple
