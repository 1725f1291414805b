#include "apps/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "core/config.h"
#include "core/input_file.h"
#include "core/text.h"
#include "study/explore/space.h"
#include "study/report/json_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// The axes but those that the systems alone set.
std::vector<SpaceAxis> own_axes(const Space& space) {
    std::vector<SpaceAxis> axes = space.axes;
    std::erase_if(axes, [](const SpaceAxis& axis) { return axis.values.front().empty(); });
    return axes;
}

ordered_json space_json(const Space& space, const std::string& file) {
    ordered_json json{
        {"kind", "space"},
        {"file", file},
        {"points", space.size()},
        {"axes", ordered_json::array()},
        {"systems", ordered_json::array()},
        {"frames", space.frames},
        {"scene",
         {{"width", space.scene.cols},
          {"height", space.scene.rows},
          {"planes", space.scene.planes}}},
        {"readout",
         {{"width", nullptr}, {"height", nullptr}, {"sensor", or_null(space.readout_sensor)}}}};
    if (space.readout.rows > 0) {
        json["readout"]["width"] = space.readout.cols;
        json["readout"]["height"] = space.readout.rows;
    }
    for (const SpaceAxis& axis : own_axes(space))
        json["axes"].push_back({{"name", axis.name}, {"values", axis.values}});
    for (const SpaceSystem& system : space.systems) {
        auto values = ordered_json::object();
        for (const auto& [axis, value] : system.values) values[axis] = value;
        json["systems"].push_back({{"name", system.name}, {"values", values}});
    }
    return json;
}

/// "6, 8, 10", or of many values the first and the last.
std::string values_text(const std::vector<std::string>& values) {
    constexpr std::size_t kShown = 8;
    if (values.size() <= kShown) return joined(values);
    return fmt::format("{}, ... {} ({})", joined(std::span(values).first(kShown - 2)),
                       values.back(), counted(values.size(), "value"));
}

std::string axes_text(const Space& space) {
    std::vector<SpaceAxis> axes = own_axes(space);
    std::erase_if(axes, [](const SpaceAxis& axis) { return axis.name == "system"; });
    const std::size_t width = column_width(axes, &SpaceAxis::name);
    std::string text;
    for (const SpaceAxis& axis : axes)
        text += fmt::format("\n  {:<{}}  {}", axis.name, width, values_text(axis.values));
    return text;
}

std::string systems_text(const Space& space) {
    const std::size_t width = column_width(space.systems, &SpaceSystem::name);
    std::string text;
    for (const SpaceSystem& system : space.systems) {
        text += fmt::format("{}\n  {:<{}} ", text.empty() ? "\nsystems" : "", system.name, width);
        for (const auto& [axis, value] : system.values) text += fmt::format(" {}={}", axis, value);
    }
    return text;
}

std::string readout_text(const Space& space) {
    const std::string window =
        space.readout.rows > 0
            ? fmt::format("{} x {} pixels", space.readout.cols, space.readout.rows)
        : space.readout_sensor.empty() ? "the window of the clip"
                                       : "the whole array";
    return fmt::format(
        "{}, by the clocks of {}", window,
        space.readout_sensor.empty() ? "the sensor of the point" : space.readout_sensor);
}

}  // namespace

void info_space(const std::string& name, const RunOptions& run) {
    const std::string file = find_config(ConfigKind::kSpaces, name).string();
    const auto bytes = read_file(file);
    const Space space = parse_space({bytes.begin(), bytes.end()}, file);
    JsonFile json(run);
    json.write(space_json(space, file));
    run.say(
        fmt::format("space        {}: {} (stipple explore)\naxes{}{}\n"
                    "clip         {} at most, of scenes {} x {} x {} (width x height x planes)\n"
                    "readout      {}",
                    file, counted(space.size(), "point"), axes_text(space), systems_text(space),
                    counted(space.frames, "slot"), space.scene.cols, space.scene.rows,
                    space.scene.planes, readout_text(space)));
}

}  // namespace stipple
