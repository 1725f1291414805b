#include "study/explore/point_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/error.h"
#include "core/text.h"
#include "io/footage_part.h"

namespace stipple {
namespace {

/// The value of an axis that the space may not have; empty: the default.
std::string value_of(const Space& space, const SpacePoint& point, std::string_view name) {
    const std::size_t place = space.axis(name);
    return place == space.axes.size() ? "" : point[place];
}

FluxVideo part_of(const FluxVideo& light, const FootagePart& part) {
    FrameReduction reduction(part, light.shape(), ColourFilter::kNone, "the clip");
    FluxVideo of_part(light.slots(), reduction.shape());
    for (int slot = 0; slot < light.slots(); ++slot)
        reduction(light.frame(slot), of_part.frame(slot));
    return of_part;
}

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

FrameShape PointView::window(FrameShape array) const {
    return {std::max(1, static_cast<int>(rows * array.rows)), array.cols, array.planes};
}

FrameShape PointView::binned(FrameShape window) const {
    return {window.rows / binning, window.cols / binning, window.planes};
}

bool has_view(const Space& space, const SpacePoint& point) {
    return std::ranges::any_of(
        kViewAxes, [&](const char* name) { return !value_of(space, point, name).empty(); });
}

PointView view_of(const Space& space, const SpacePoint& point) {
    PointView view;
    if (const std::string text = value_of(space, point, "binning"); !text.empty()) {
        const auto n = parsed_number<int>(text);
        if (!n || *n < 1 || *n > kMaxBinning)
            throw InputError("binning", fmt::format("\"{}\" is not a whole number from 1 to {}",
                                                    text, kMaxBinning));
        view.binning = *n;
    }
    if (const std::string text = value_of(space, point, "binning_mode"); !text.empty())
        view.mode = value_in(kBinningModes, text, "binning_mode");
    if (const std::string text = value_of(space, point, "window_rows"); !text.empty()) {
        const auto rows = parsed_number<double>(text);
        if (!rows || !(*rows > 0 && *rows <= 1))
            throw InputError(
                "window_rows",
                fmt::format("\"{}\" is not a fraction of the rows, above 0 and up to 1", text));
        view.rows = *rows;
    }
    if (view.binning > 1 && !space.rig(point).empty())
        throw InputError("binning", "is of one sensor, but the point has a rig");
    return view;
}

FluxVideo window_light(const FluxVideo& light, const PointView& view) {
    const FrameShape window = view.window(light.shape());
    return part_of(light, {.crop = CropArea{window.rows, window.cols}});
}

FluxVideo binned_light(const FluxVideo& window, const PointView& view) {
    return part_of(window, {.bin = view.binning});
}

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
