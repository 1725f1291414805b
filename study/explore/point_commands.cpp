#include "study/explore/results.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <cstdint>
#include <sstream>
#include <string_view>

#include "core/text.h"
#include "readout/provenance.h"
#include "study/explore/point_view.h"
#include "study/explore/trial.h"

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
/// only, and they know neither binning nor windows of a sensor.
bool has_steps(const Space& space, const SpacePoint& point) {
    return !has_view(space, point) &&
           (space.rig(point).empty() ||
            (space.value(point, "sensor") == SensorChoice().sensor &&
             space.value(point, "seed") == std::to_string(SensorChoice().seed) &&
             space.settings(point, "sensor").empty()));
}

/// `compare` leaves out as many frames at both ends: the first end + begin have the same middle.
std::string compare_command(const std::string& footage, const PointClip& clip) {
    auto [begin, end] = clip.compared;
    if (begin >= end) end = clip.slots - (begin = usual_margin(clip.slots));
    const std::string until =
        begin + end < clip.slots ? fmt::format(" --until {}", begin + end) : "";
    return begin + end > clip.slots ? ""
                                    : fmt::format(
                                          "stipple compare decoded.npy {}{} --margin {} "
                                          "--max-value {}\n",
                                          footage, until, begin, kBrightestLight);
}

std::string steps(const Space& space, const SpacePoint& point, const PointClip& clip) {
    const auto value = [&](std::string_view name) { return space.value(point, name); };
    std::string footage = operand(value("footage"));
    std::string text, reading = options_of(clip.reading);
    if (is_scene(value("footage"))) {
        text = fmt::format("stipple synth {} -o scene.npy --frames {} --size {}x{}{}\n", footage,
                           clip.slots, space.scene.cols, space.scene.rows,
                           space.scene.planes == 1 ? " --luminance" : "");
        footage = "scene.npy";
        reading.clear();
    }
    const std::string rig = space.rig(point);
    const std::string stream = rig.empty() ? "clip.stipple" : "clip";
    if (!reading.empty()) reading += " --truth light.npy";
    if (rig.empty())
        text += fmt::format("stipple emulate {} -o {}{} --sensor {} --schedule {} --seed {}{}{}\n",
                            footage, stream, reading, operand(value("sensor")),
                            operand(value("schedule")), shell_quoted(value("seed")),
                            settings(space, point, "sensor"), settings(space, point, "schedule"));
    else
        text += fmt::format("stipple emulate {} -o {}{} --rig {}{}\n", footage, stream, reading,
                            operand(rig), settings(space, point, "rig"));
    text += fmt::format("stipple decode {} -o decoded.npy --method {}{}\n", stream,
                        shell_quoted(value("method")), settings(space, point, "decoder"));
    return text + compare_command(reading.empty() ? footage : "light.npy", clip);
}

}  // namespace

std::string point_space(const Space& space, const SpacePoint& point, const PointClip& clip) {
    toml::table axes, set;
    for (std::size_t i = 0; i < point.size(); ++i) {
        const std::string& name = space.axes[i].name;
        if (name == "system" || point[i].empty()) continue;  // the point has all that it stands for
        (name.find('.') == std::string::npos ? axes : set).insert(name, only(point[i]));
    }
    toml::table of_clip{{"frames", clip.slots},
                        {"rows", space.scene.rows},
                        {"cols", space.scene.cols},
                        {"planes", space.scene.planes}};
    const auto [begin, end] = clip.compared;
    if (begin < end) of_clip.insert("compared", toml::array{begin, end});
    toml::table text{{"axes", axes}, {"clip", of_clip}};
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

std::string point_commands(const Space& space, const SpacePoint& point, const PointClip& clip) {
    const std::string reading =
        is_scene(space.value(point, "footage")) ? "" : options_of(clip.reading);
    const std::string seeds = clip.seeds > 1 ? fmt::format(" --seeds {}", clip.seeds) : "";
    std::string text =
        fmt::format("cat > point.toml <<'END'\n{}END\n", point_space(space, point, clip));
    if (const OwnDecoder* own = space.own_decoder(point))
        return text + fmt::format(
                          "# Then stipple.explore in Python, with the decoder \"{}\" as its "
                          "methods.\n",
                          own->name);
    text += fmt::format("stipple explore point.toml -o point{}{}\n", reading, seeds);
    if (clip.is_whole && has_steps(space, point))
        text += fmt::format("\n# {} step by step\n",
                            seeds.empty() ? "the same" : "that of the first seed") +
                steps(space, point, clip);
    return text;
}

}  // namespace stipple
