#include "explore/point_rig.h"

#include <fmt/format.h>

#include <cstdint>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/parsed_number.h"

namespace stipple {
namespace {

std::uint64_t seed_of(const std::string& text) {
    if (const auto seed = parsed_number<std::uint64_t>(text)) return *seed;
    throw InputError("seed", fmt::format("\"{}\" is not a whole number", text));
}

/// \throws InputError if the point sets a key of `section`.
void check_unset(const Space& space, const SpacePoint& point, std::string_view section,
                 std::string_view problem) {
    const auto settings = space.settings(point, section);
    if (settings.empty()) return;
    const std::string key = settings.front().substr(0, settings.front().find('='));
    throw InputError(fmt::format("set.{}.{}", section, key), problem);
}

Rig one_sensor(const Space& space, const SpacePoint& point) {
    check_unset(space, point, "rig", "is a key of a rig, but the point has none");
    return {.name = {},
            .sensors = {{.name = "sensor",
                         .choice = {.sensor = space.value(point, "sensor"),
                                    .schedule = space.value(point, "schedule"),
                                    .settings = space.settings(point, "sensor"),
                                    .schedule_settings = space.settings(point, "schedule"),
                                    .seed = seed_of(space.value(point, "seed"))}}}};
}

}  // namespace

PointRig rig_of(const Space& space, const SpacePoint& point) {
    const std::string file = space.rig(point);
    if (file.empty()) return {one_sensor(space, point), {}};
    check_unset(space, point, "schedule",
                "is a key of one sensor, but the point has a rig: use rig.NAME.set");
    const std::string& sensor = space.value(point, "sensor");
    Config config(find_config(ConfigKind::kRigs, file), space.settings(point, "rig"), "rig");
    PointRig found{read_rig(config, sensor), config.as_toml("")};
    const auto settings = space.settings(point, "sensor");
    const std::uint64_t seeds = Rig::kMaxSensors * (seed_of(space.value(point, "seed")) - 1);
    for (RigSensor& own : found.rig.sensors) {
        SensorChoice& choice = own.choice;
        if (choice.sensor != sensor)
            throw InputError(config.where(own.name + ".sensor"),
                             fmt::format("is \"{}\", but axes.sensor \"{}\"; without the key it is "
                                         "that of the axis",
                                         choice.sensor, sensor));
        choice.settings.insert(choice.settings.end(), settings.begin(), settings.end());
        choice.seed += seeds;
    }
    return found;
}

}  // namespace stipple
