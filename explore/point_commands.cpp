#include "explore/point_commands.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "core/parsed_number.h"
#include "core/shell_quoted.h"
#include "explore/trial.h"

namespace stipple {
namespace {

/// A value of an axis as a list of one. A text stands for any value, as in --set; whole numbers are
/// nicer to read.
toml::array only(const std::string& value) {
    const auto number = parsed_number<std::int64_t>(value);
    if (number && std::to_string(*number) == value) return toml::array{*number};
    return toml::array{value};
}

/// The options --set of a section.
std::string settings(const Space& space, const SpacePoint& point, const std::string& section) {
    std::string text;
    for (const std::string& setting : space.settings(point, section))
        text += " --set " + shell_quoted(fmt::format("{}.{}", section, setting));
    return text;
}

/// A name that does not look like an option.
std::string operand(const std::string& name) {
    return shell_quoted(name.starts_with('-') ? "./" + name : name);
}

/// Whether the other commands can make the point: to a rig as it is they can tell its own keys
/// only.
bool has_steps(const Space& space, const SpacePoint& point) {
    return space.rig(point).empty() ||
           (space.value(point, "sensor") == SensorChoice().sensor &&
            space.value(point, "seed") == std::to_string(SensorChoice().seed) &&
            space.settings(point, "sensor").empty());
}

std::string steps(const Space& space, const SpacePoint& point, int slots) {
    const auto value = [&](std::string_view name) { return space.value(point, name); };
    std::string footage = operand(value("footage"));
    std::string text;
    if (is_scene(value("footage"))) {
        text = fmt::format("stipple synth {} -o scene.npy --frames {} --size {}x{}{}\n", footage,
                           slots, space.scene.cols, space.scene.rows,
                           space.scene.planes == 1 ? " --luminance" : "");
        footage = "scene.npy";
    }
    const std::string rig = space.rig(point);
    const std::string stream = rig.empty() ? "clip.stipple" : "clip";
    if (rig.empty())
        text += fmt::format("stipple emulate {} -o {} --sensor {} --schedule {} --seed {}{}{}\n",
                            footage, stream, operand(value("sensor")), operand(value("schedule")),
                            shell_quoted(value("seed")), settings(space, point, "sensor"),
                            settings(space, point, "schedule"));
    else
        text += fmt::format("stipple emulate {} -o {} --rig {}{}\n", footage, stream, operand(rig),
                            settings(space, point, "rig"));
    text += fmt::format("stipple decode {} -o decoded.npy --method {}{}\n", stream,
                        shell_quoted(value("method")), settings(space, point, "decoder"));
    const QualityOptions quality = trial_quality(slots);
    return text + fmt::format("stipple compare decoded.npy {} --margin {} --max-value {}\n",
                              footage, quality.margin, *quality.max_value);
}

}  // namespace

std::string point_space(const Space& space, const SpacePoint& point, int slots) {
    toml::table axes, set;
    for (std::size_t i = 0; i < point.size(); ++i) {
        const std::string& name = space.axes[i].name;
        if (name == "system" || point[i].empty()) continue;  // the point has all that it stands for
        (name.find('.') == std::string::npos ? axes : set).insert(name, only(point[i]));
    }
    toml::table text{{"axes", axes},
                     {"clip", toml::table{{"frames", slots},
                                          {"rows", space.scene.rows},
                                          {"cols", space.scene.cols},
                                          {"planes", space.scene.planes}}}};
    if (!set.empty()) text.insert("set", set);
    toml::table readout;
    if (space.readout.rows > 0)
        readout = toml::table{{"rows", space.readout.rows}, {"cols", space.readout.cols}};
    if (!space.readout_sensor.empty()) readout.insert("sensor", space.readout_sensor);
    if (!readout.empty()) text.insert("readout", readout);
    std::ostringstream stream;
    stream << toml::toml_formatter(
        text, toml::toml_formatter::default_flags & ~(toml::format_flags::allow_multi_line_strings |
                                                      toml::format_flags::allow_literal_strings));
    return stream.str() + "\n";
}

std::string point_commands(const Space& space, const SpacePoint& point, int slots, bool is_whole) {
    std::string text =
        fmt::format("cat > point.toml <<'END'\n{}END\nstipple explore point.toml -o point\n",
                    point_space(space, point, slots));
    if (is_whole && has_steps(space, point))
        text += "\n# the same step by step\n" + steps(space, point, slots);
    return text;
}

}  // namespace stipple
