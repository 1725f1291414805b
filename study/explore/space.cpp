#include "study/explore/space.h"

#include <fmt/format.h>

#include <toml++/toml.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "core/text.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

constexpr int kMaxCount = 10'000;

constexpr const char* kTwoSchedules =
    "stands beside a schedule, but the sensors of a rig have their own; leave out one";

/// Axes of a name, slowest first; those with a default may be left out. One whose default is empty
/// is there only if a point has a value of it.
struct NamedAxis {
    std::string_view name;
    const char* fallback;
    bool of_systems = false;  ///< set by them, if there are any
};
constexpr std::array<NamedAxis, 9> kNamedAxes{{{"footage", "pan"},
                                               {"sensor", nullptr},
                                               {"schedule", "random", true},
                                               {"rig", "", true},
                                               {"method", "fast", true},
                                               {"seed", "1"},
                                               {"binning", "", true},
                                               {"binning_mode", "", true},
                                               {"window_rows", "", true}}};

std::vector<std::string_view> axis_names() {
    std::vector<std::string_view> names;
    names.reserve(kNamedAxes.size());
    for (const NamedAxis& axis : kNamedAxes) names.push_back(axis.name);
    return names;
}

/// Reads the tables of a space; messages name the file and the key.
class SpaceReader {
  public:
    explicit SpaceReader(std::string file) : file_(std::move(file)) {}

    [[nodiscard]] Space read(const toml::table& tables) const;

  private:
    [[noreturn]] void fail(const std::string& key, const std::string& problem) const {
        throw InputError(fmt::format("{}: {}", file_, key), problem);
    }
    [[nodiscard]] std::string text(const std::string& key, const toml::node& node) const;
    [[nodiscard]] std::vector<std::string> values(const std::string& key,
                                                  const toml::node& node) const;
    [[nodiscard]] std::vector<std::string> range(const std::string& key,
                                                 const toml::table& table) const;
    [[nodiscard]] int whole(const toml::table& table, const std::string& key, int fallback,
                            int max) const;
    [[nodiscard]] ComparedSlots slot_range(const toml::node& node) const;
    void add_axes(Space& space, const toml::table& tables) const;
    void add_systems(Space& space, const toml::node* list) const;
    [[nodiscard]] SpaceSystem system(const toml::table& table, const std::string& key) const;
    void check_setting(const std::string& name) const;
    [[nodiscard]] const toml::table& section(const toml::table& tables,
                                             const std::string& name) const;
    void check_keys(const toml::table& table, const std::string& section,
                    const std::vector<std::string_view>& known) const;

    std::string file_;
};

/// A value as TOML, but a text without quotes.
std::string SpaceReader::text(const std::string& key, const toml::node& node) const {
    if (const auto* word = node.as_string(); word != nullptr && !word->get().empty())
        return word->get();
    if (node.is_string()) fail(key, "is an empty text");
    if (node.is_table() || node.is_date() || node.is_time() || node.is_date_time())
        fail(key, "has a value that is not a number, text, boolean or list");
    std::ostringstream text;
    if (const auto* list = node.as_array())
        text << toml::toml_formatter(*list);
    else if (const auto number = node.value_exact<std::int64_t>())
        text << *number;
    else if (const auto real = node.value_exact<double>())
        text << fmt::format("{}", *real);
    else
        text << (node.value_or(false) ? "true" : "false");
    return text.str();
}

std::vector<std::string> SpaceReader::range(const std::string& key,
                                            const toml::table& table) const {
    check_keys(table, key, {"from", "to", "count", "log"});
    const auto from = table["from"].value<double>();
    const auto to = table["to"].value<double>();
    const auto count = table["count"].value_exact<std::int64_t>();
    const bool log = table["log"].value_or(false);
    if (!from || !to || !count || *count < 2 || *count > kMaxCount || !std::isfinite(*from) ||
        !std::isfinite(*to) || (log && (*from <= 0 || *to <= 0)))
        fail(
            key,
            "is not a range such as { from = 10, to = 1000, count = 5, log = true }; count is 2 to "
            "10000, and the ends of a log range are above 0");
    const bool whole = table["from"].is_integer() && table["to"].is_integer();
    std::vector<std::string> values;
    for (std::int64_t i = 0; i < *count; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(*count - 1);
        double value = log ? *from * std::pow(*to / *from, t) : *from + (*to - *from) * t;
        if (whole) value = std::round(value);
        std::string number = fmt::format("{:.6g}", value);
        if (whole) number = fmt::format("{:.0f}", value);
        if (values.empty() || values.back() != number) values.push_back(std::move(number));
    }
    return values;
}

std::vector<std::string> SpaceReader::values(const std::string& key, const toml::node& node) const {
    if (const auto* table = node.as_table()) return range(key, *table);
    const auto* list = node.as_array();
    if (list == nullptr) return {text(key, node)};
    if (list->empty()) fail(key, "is an empty list; give at least one value, or leave it out");
    std::vector<std::string> values;
    for (const toml::node& item : *list) values.push_back(text(key, item));
    return values;
}

int SpaceReader::whole(const toml::table& table, const std::string& key, int fallback,
                       int max) const {
    const toml::node* node = table.get(key.substr(key.find('.') + 1));
    if (node == nullptr) return fallback;
    const auto number = node->is_integer() ? node->value<std::int64_t>() : std::nullopt;
    if (!number || *number < 1 || *number > max)
        fail(key, fmt::format("is not a whole number of 1 to {}", max));
    return static_cast<int>(*number);
}

ComparedSlots SpaceReader::slot_range(const toml::node& node) const {
    const auto* list = node.as_array();
    const auto slot = [&](std::size_t i) {
        const auto number = list != nullptr && list->size() == 2
                                ? (*list)[i].value_exact<std::int64_t>()
                                : std::nullopt;
        return number && *number <= SceneOptions::kMaxSlots ? static_cast<int>(*number) : -1;
    };
    const ComparedSlots range{slot(0), slot(1)};
    if (range.begin < 0 || range.begin >= range.end)
        fail("clip.compared", "is not a list of the first slot and the one after the last");
    return range;
}

void SpaceReader::check_keys(const toml::table& table, const std::string& section,
                             const std::vector<std::string_view>& known) const {
    for (const auto& [key, node] : table)
        if (std::ranges::find(known, key.str()) == known.end())
            fail(section + (section.empty() ? "" : ".") + std::string(key.str()),
                 "is unknown here; see docs/explore.md");
}

const toml::table& SpaceReader::section(const toml::table& tables, const std::string& name) const {
    static const toml::table kNone;
    const toml::node* node = tables.get(name);
    if (node != nullptr && !node->is_table()) fail(name, "is not a section");
    return node == nullptr ? kNone : *node->as_table();
}

void SpaceReader::check_setting(const std::string& name) const {
    if (!name.starts_with("sensor.") && !name.starts_with("schedule.") &&
        !name.starts_with("decoder.") && !name.starts_with("rig."))
        fail("set." + name,
             "begins neither with sensor. nor schedule. nor decoder. nor rig.; put it "
             "into quotes: \"sensor.bit_depth\" = [8, 10]");
}

SpaceSystem SpaceReader::system(const toml::table& table, const std::string& key) const {
    check_keys(
        table, key,
        {"name", "schedule", "rig", "method", "binning", "binning_mode", "window_rows", "set"});
    const bool has_rig = table.contains("rig");
    if (has_rig && table.contains("schedule")) fail(key + ".rig", kTwoSchedules);
    SpaceSystem system;
    for (const char* name : {"name", has_rig ? "rig" : "schedule", "method"}) {
        const toml::node* node = table.get(name);
        if (node == nullptr) fail(key + "." + name, "is missing");
        const std::string value = text(key + "." + name, *node);
        if (name == std::string_view("name"))
            system.name = value;
        else
            system.values.emplace_back(name, value);
    }
    for (const char* name : kViewAxes)
        if (const toml::node* node = table.get(name))
            system.values.emplace_back(name, text(key + "." + name, *node));
    for (const auto& [setting, node] : section(table, "set")) {
        const std::string name(setting.str());
        check_setting(name);
        if (name.starts_with(has_rig ? "schedule." : "rig."))
            fail(fmt::format("{}.set.{}", key, name),
                 has_rig ? "is a key of one sensor, but the system has a rig: use rig.NAME.set"
                         : "is a key of a rig, but the system has none");
        system.values.emplace_back(name, text(fmt::format("{}.set.{}", key, name), node));
    }
    return system;
}

/// Adds the axis of the systems, and those of their keys, whose values a system sets.
void SpaceReader::add_systems(Space& space, const toml::node* list) const {
    if (list == nullptr) return;
    const toml::array* tables = list->as_array();
    if (tables == nullptr || !tables->is_array_of_tables() || tables->empty())
        fail("systems", "is not a list of tables, each headed [[systems]]");
    SpaceAxis names{"system", {}};
    for (std::size_t i = 0; i < tables->size(); ++i) {
        space.systems.push_back(
            system(*tables->get(i)->as_table(), fmt::format("systems.{}", i + 1)));
        const std::string& name = space.systems.back().name;
        if (std::ranges::find(names.values, name) != names.values.end())
            fail("systems", fmt::format("has two of the name \"{}\"", name));
        names.values.push_back(name);
    }
    space.axes.push_back(std::move(names));
    for (const SpaceSystem& system : space.systems)
        for (const auto& [name, value] : system.values)
            if (std::ranges::find(space.axes, name, &SpaceAxis::name) == space.axes.end())
                space.axes.push_back({name, {""}});
}

void SpaceReader::add_axes(Space& space, const toml::table& tables) const {
    const toml::table& axes = section(tables, "axes");
    check_keys(axes, "axes", axis_names());
    const bool has_rig = axes.contains("rig");
    if (has_rig && axes.contains("schedule")) fail("axes.rig", kTwoSchedules);
    const toml::node* systems = tables.get("systems");
    for (const auto& [name, fallback, of_system] : kNamedAxes) {
        const toml::node* node = axes.get(name);
        const bool of_systems = systems != nullptr && of_system;
        if (node != nullptr && of_systems)
            fail("axes." + std::string(name), "is set by each of the systems; leave it out");
        if (node == nullptr && fallback == nullptr)
            fail("axes.sensor",
                 "is missing; name a sensor of \"stipple list sensors\", or several");
        if (node != nullptr)
            space.axes.push_back({std::string(name), values("axes." + std::string(name), *node)});
        else if (fallback == nullptr || *fallback != '\0') {
            const bool is_set = of_systems || (has_rig && name == "schedule");
            space.axes.push_back({std::string(name), {is_set ? "" : fallback}});
        }
    }
    add_systems(space, systems);
    for (const auto& [key, node] : section(tables, "set")) {
        const std::string name(key.str());
        check_setting(name);
        if (std::ranges::find(space.axes, name, &SpaceAxis::name) != space.axes.end())
            fail("set." + name, "is set by a system too; give it in one place");
        space.axes.push_back({name, values("set." + name, node)});
    }
}

Space SpaceReader::read(const toml::table& tables) const {
    check_keys(tables, "", {"axes", "systems", "set", "clip", "readout"});
    Space space;
    add_axes(space, tables);
    const toml::table& clip = section(tables, "clip");
    check_keys(clip, "clip", {"frames", "rows", "cols", "planes", "compared"});
    space.frames = whole(clip, "clip.frames", space.frames, SceneOptions::kMaxSlots);
    space.scene.rows = whole(clip, "clip.rows", space.scene.rows, SceneOptions::kMaxSide);
    space.scene.cols = whole(clip, "clip.cols", space.scene.cols, SceneOptions::kMaxSide);
    space.scene.planes = whole(clip, "clip.planes", space.scene.planes, 3);
    if (const toml::node* compared = clip.get("compared")) space.compared = slot_range(*compared);
    const toml::table& readout = section(tables, "readout");
    check_keys(readout, "readout", {"rows", "cols", "sensor"});
    space.readout.rows = whole(readout, "readout.rows", 0, kMaxFrameSide);
    space.readout.cols = whole(readout, "readout.cols", 0, kMaxFrameSide);
    if ((space.readout.rows == 0) != (space.readout.cols == 0))
        fail("readout", "needs both rows and cols");
    if (const toml::node* sensor = readout.get("sensor"))
        space.readout_sensor = text("readout.sensor", *sensor);
    return space;
}

}  // namespace

void Space::replace(const SpaceAxis& other) {
    const auto found = std::ranges::find(axes, other.name, &SpaceAxis::name);
    if (found == axes.end()) throw InputError("the space", "has no axis \"" + other.name + "\"");
    for (const std::string& value : other.values)
        if (other.name == "system" &&
            std::ranges::find(systems, value, &SpaceSystem::name) == systems.end())
            throw InputError(fmt::format("system \"{}\"", value),
                             "is unknown; " + suggestion(value, found->values));
    bool of_systems = false;
    for (SpaceSystem& system : systems)
        for (auto& [name, value] : system.values)
            if (name == other.name) {
                value = other.values.front();
                of_systems = true;
            }
    if (of_systems) return;
    found->values = other.values;
    if (other.name != "system") return;
    const auto is_named = [&](const std::string& system) {
        return std::ranges::find(other.values, system) != other.values.end();
    };
    for (const SpaceSystem& system : systems)
        if (is_named(system.copy_of) && !is_named(system.name))
            found->values.push_back(system.name);
}

std::string Space::rig(const SpacePoint& point) const {
    const std::size_t place = axis("rig");
    return place == axes.size() ? "" : point[place];
}

std::vector<std::string> Space::settings(const SpacePoint& point, std::string_view section) const {
    std::vector<std::string> settings;
    for (std::size_t i = 0; i < point.size(); ++i) {
        const std::string& name = axes[i].name;
        if (name.starts_with(section) && name.size() > section.size() &&
            name[section.size()] == '.' && !point[i].empty())
            settings.push_back(fmt::format("{}={}", name.substr(section.size() + 1), point[i]));
    }
    return settings;
}

std::uint64_t Space::size() const {
    double points = 1;  // exact as far as it matters
    for (const SpaceAxis& axis : axes) points *= static_cast<double>(axis.values.size());
    return static_cast<std::uint64_t>(std::min(points, 1e18));
}

SpacePoint Space::point(std::uint64_t number) const {
    SpacePoint values(axes.size());
    for (std::size_t i = axes.size(); i-- > 0;) {
        values[i] = axes[i].values[number % axes[i].values.size()];
        number /= axes[i].values.size();
    }
    for (const SpaceSystem& system : systems)
        if (system.name == value(values, "system"))
            for (const auto& [name, chosen] : system.values) values[axis(name)] = chosen;
    return values;
}

std::size_t Space::axis(std::string_view name) const {
    return static_cast<std::size_t>(std::ranges::find(axes, name, &SpaceAxis::name) - axes.begin());
}

Space parse_space(const std::string& text, const std::string& name) {
    if (const std::size_t line = line_of_long_key(text); line != 0)
        throw InputError(fmt::format("{}:{}", name, line),
                         fmt::format("a key has more than {} parts", kMaxKeyParts));
    toml::table tables;
    try {
        tables = toml::parse(text, name);
    } catch (const toml::parse_error& e) {
        throw InputError(fmt::format("{}:{}", name, e.source().begin.line),
                         std::string(e.description()));
    }
    Space space = SpaceReader(name).read(tables);
    if (space.size() > Space::kMaxPoints)
        throw InputError(name, fmt::format("has {} points, more than {}; give fewer values",
                                           space.size(), Space::kMaxPoints));
    return space;
}

}  // namespace stipple
