#include "study/explore/results.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/version.h"
#include "study/explore/exploration.h"
#include "study/report/report_page.h"

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

using nlohmann::ordered_json;

std::string base64(const std::vector<std::uint8_t>& bytes) {
    std::string text((bytes.size() + 2) / 3 * 4 + 1, '\0');  // EVP_EncodeBlock ends it with a zero
    EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()), bytes.data(),
                    static_cast<int>(bytes.size()));
    text.pop_back();
    return text;
}

ordered_json columns_json() {
    ordered_json columns = ordered_json::array();
    for (const FigureColumn& column : kFigureColumns)
        columns.push_back({{"name", column.name},
                           {"title", column.title},
                           {"more_is_better", column.better == Better::kMore}});
    return columns;
}

/// Numbers that JSON does not have are null.
ordered_json figures_json(const TrialFigures& figures) {
    ordered_json list = ordered_json::array();
    for (const FigureColumn& column : kFigureColumns) {
        const double value = figures.*column.value;
        list.push_back(std::isfinite(value) ? ordered_json(value) : ordered_json());
    }
    return list;
}

/// Half the width of the interval of each figure; null if it has none.
ordered_json half_widths_json(const ExploredPoint& point) {
    ordered_json list = ordered_json::array();
    for (const FigureColumn& column : kFigureColumns) {
        list.push_back(nullptr);
        if (!has_interval(column) || point.trials.size() < 2) continue;
        const MeanInterval interval = mean_interval(samples_of(point.trials, column.value));
        const double half = interval.high - interval.mean;
        if (std::isfinite(half)) list.back() = half;
    }
    return list;
}

/// The points of the page: the best ones, then those without figures.
std::vector<std::uint64_t> shown_points(const Exploration& exploration, std::size_t most) {
    std::vector<std::uint64_t> shown = exploration.best_first();
    for (std::uint64_t number = 0; number < exploration.points().size(); ++number) {
        const ExploredPoint& point = exploration.points()[number];
        if (point.touched && !point.figures) shown.push_back(number);
    }
    shown.resize(std::min(shown.size(), most));
    return shown;
}

/// Makes the rows of the page, with pictures as long as there is room for them.
class PageRows {
  public:
    PageRows(const Exploration& exploration, std::size_t picture_bytes)
        : exploration_(exploration), room_(picture_bytes) {}

    [[nodiscard]] ordered_json row(std::uint64_t number);
    [[nodiscard]] std::size_t left_out() const { return left_out_; }

  private:
    [[nodiscard]] ordered_json picture(const ExploredPoint& point);

    const Exploration& exploration_;
    std::size_t room_;
    std::size_t left_out_ = 0;
};

ordered_json PageRows::row(std::uint64_t number) {
    const ExploredPoint& point = exploration_.points()[number];
    const Space& space = exploration_.space();
    const SpacePoint values = space.point(number);
    const int slots = point.figures ? point.slots : space.frames;
    ordered_json row{{"number", number + 1}, {"values", values}};
    row["figures"] = figures_json(point.figures.value_or(TrialFigures()));
    row["half_widths"] = half_widths_json(point);
    row["rank"] = text_of(point.rank);
    row["limited_by"] = point.figures ? point.figures->limited_by : "";
    row["compared_slots"] = point.figures ? point.figures->compared_slots : "";
    row["rung"] = point.rung;
    row["slots"] = point.slots;
    row["problem"] = point.problem;
    const PointClip clip{slots, point.compared, exploration_.is_whole(number, slots),
                         exploration_.reading(), exploration_.seeds()};
    row["commands"] = point_commands(space, values, clip);
    row["file"] = point.figures ? "trials/" + point.trials.front().address + ".png" : "";
    row["picture"] = picture(point);
    return row;
}

ordered_json PageRows::picture(const ExploredPoint& point) {
    if (!point.figures) return nullptr;
    const std::vector<std::uint8_t> png =
        exploration_.store().picture(point.trials.front().address);
    if (png.empty()) return nullptr;
    std::string text = base64(png);
    if (text.size() > room_) {
        room_ = 0;  // so that the pictures of the best points are whole
        ++left_out_;
        return nullptr;
    }
    room_ -= text.size();
    return text;
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

void write_tables(const Exploration& exploration) {
    exploration.store().write("table.csv", csv_table(exploration));
    if (const std::string table = footage_table(exploration); !table.empty())
        exploration.store().write("footage.csv", table);
}

std::string results_page(const Exploration& exploration, const std::string& title,
                         const std::string& command, const PageBounds& bounds) {
    const auto& points = exploration.points();
    const auto touched = static_cast<std::size_t>(
        std::ranges::count_if(points, [](const ExploredPoint& point) { return point.touched; }));
    PageRows rows(exploration, bounds.picture_bytes);
    ordered_json data{{"title", title},
                      {"program", fmt::format("stipple {}", version())},
                      {"command", command},
                      {"points", points.size()},
                      {"seeds", exploration.seeds()},
                      {"rungs", exploration.rungs()},
                      {"columns", columns_json()}};
    data["axes"] = ordered_json::array();
    for (const SpaceAxis& axis : exploration.space().axes) data["axes"].push_back(axis.name);
    data["rows"] = ordered_json::array();
    for (const std::uint64_t number : shown_points(exploration, bounds.points))
        data["rows"].push_back(rows.row(number));
    data["notes"] = ordered_json::array();
    const auto note = [&](bool holds, const std::string& text) {
        if (holds) data["notes"].push_back(text);
    };
    for (const ExploredPoint& point : points) {
        if (!point.figures) continue;
        note(true,
             fmt::format("compared: slots {} of {}, the same for all points of a rung and a clip",
                         point.figures->compared_slots, point.slots));
        break;
    }
    note(touched < points.size(),
         fmt::format("{} of {} points were reached; the same command goes on with the rest",
                     touched, points.size()));
    note(data["rows"].size() < touched,
         fmt::format("the page has the best {} of {} points, table.csv has all",
                     data["rows"].size(), touched));
    note(rows.left_out() > 0,
         fmt::format("the pictures of {} points lie beside the page only, in trials/, as those in "
                     "the page are bounded to {:.0f} MB",
                     rows.left_out(), 1e-6 * static_cast<double>(bounds.picture_bytes)));
    return exploration_page(title,
                            data.dump(-1, ' ', false, ordered_json::error_handler_t::replace));
}

}  // namespace stipple
