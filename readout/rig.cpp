#include "readout/rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "core/config.h"
#include "core/error.h"
#include "core/named_value.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

constexpr auto kApertures = std::to_array<NamedValue<RigAperture>>(
    {{"shared", RigAperture::kShared}, {"own", RigAperture::kOwn}});
constexpr KeyRange kShare{1e-6, 1};
constexpr KeyRange kPixels{-kMaxFrameSide, kMaxFrameSide};
constexpr KeyRange kEntry{-1e9, 1e9};
constexpr KeyRange kSlots{0, 1e9};
/// Of shares such as 0.333 and 1/3, which are not exact.
constexpr double kShareRounding = 1e-9;

bool is_name(std::string_view name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    return !name.empty() && name.size() <= 32 && std::ranges::all_of(name, fits);
}

std::vector<std::string> read_names(Config& config) {
    const ConfigKey key{"sensors", {}, "", "names of the sensors; the first is the reference"};
    const auto fail = [&](const std::string& problem) {
        throw InputError(config.where(key.name), problem);
    };
    auto names = config.texts(key);
    if (names.empty()) fail("names no sensor; write sensors = [\"left\", \"right\"]");
    if (names.size() > Rig::kMaxSensors)
        fail(fmt::format("names {} sensors; a rig has {} at most", names.size(), Rig::kMaxSensors));
    for (auto name = names.begin(); name != names.end(); ++name) {
        if (!is_name(*name))
            fail(fmt::format("\"{}\" is not a name: 1 to 32 letters, digits, _ and -", *name));
        if (std::find(names.begin(), name, *name) != name)
            fail(fmt::format("names two sensors \"{}\"; give each a name of its own", *name));
    }
    return names;
}

/// The map of `offset_px` or `homography`.
Homography read_map(Config& config, const std::string& prefix) {
    const std::string offset_name = prefix + "offset_px";
    const std::string matrix_name = prefix + "homography";
    const auto offset = config.numbers(
        {offset_name, kPixels, "pixels", "row and column of the first sensor's pixel (0, 0)"},
        {0, 0});
    const auto matrix = config.numbers(
        {matrix_name, kEntry, "", "maps (col, row, 1) of the first sensor, row by row"},
        {Homography::kIdentity.begin(), Homography::kIdentity.end()});
    if (offset.size() != 2)
        throw InputError(config.where(offset_name),
                         fmt::format("has {} numbers; give row and column", offset.size()));
    if (matrix.size() != Homography::kIdentity.size())
        throw InputError(config.where(matrix_name),
                         fmt::format("has {} numbers, not 9", matrix.size()));
    if (!config.contains(matrix_name)) return Homography::shift({offset[0], offset[1]});
    if (config.contains(offset_name))
        throw InputError(config.where(offset_name),
                         "stands beside a homography, which holds the offset; leave out one");
    Homography::Matrix entries;
    std::ranges::copy(matrix, entries.begin());
    const Homography map(entries);
    if (map.is_singular())
        throw InputError(config.where(matrix_name),
                         "is singular: it maps the frame to a line or a point");
    return map;
}

/// Lays "sensor.KEY=VALUE" and "schedule.KEY=VALUE" out to the settings of each.
void read_settings(Config& config, const std::string& name, SensorChoice& choice) {
    constexpr std::string_view kSensor = "sensor.", kSchedule = "schedule.";
    for (const std::string& setting :
         config.texts({name, {}, "", "changed keys: [\"sensor.read_noise_e=5\"]"})) {
        if (setting.starts_with(kSensor))
            choice.settings.push_back(setting.substr(kSensor.size()));
        else if (setting.starts_with(kSchedule))
            choice.schedule_settings.push_back(setting.substr(kSchedule.size()));
        else
            throw InputError(
                config.where(name),
                fmt::format("\"{}\" begins neither with sensor. nor schedule.", setting));
    }
}

RigSensor read_rig_sensor(Config& config, const std::string& name, std::size_t number,
                          const std::string& fallback) {
    RigSensor sensor{.name = name, .choice = {.sensor = fallback}};
    auto seed = static_cast<std::int64_t>(number) + 1;
    const std::string prefix = name + ".";
    const KeyReader read(config, prefix);
    read({"sensor", {}, "", "sensor, of \"stipple list sensors\", or its file"},
         sensor.choice.sensor);
    read({"schedule", {}, "", "schedule, of \"stipple list schedules\", or its file"},
         sensor.choice.schedule);
    read_settings(config, prefix + "set", sensor.choice);
    read({"seed", {0, 0x1p53}, "", "seed of noise and schedule; default 1, 2, 3 in their order"},
         seed);
    sensor.choice.seed = static_cast<std::uint64_t>(seed);
    read({"share", kShare, "", "share of the light of the aperture"}, sensor.share);
    sensor.from_reference = read_map(config, prefix);
    read({"phase_slots", kSlots, "slots", "slots of the footage before its first one"},
         sensor.phase_slots);
    read({"sha256", {}, "", "of its stream, as \"stipple emulate\" writes it"}, sensor.sha256);
    return sensor;
}

void check_reference(const Config& config, const RigSensor& first) {
    const auto fail = [&](const char* key) {
        throw InputError(config.where(fmt::format("{}.{}", first.name, key)),
                         "moves the first sensor, which is the reference of the others; give the "
                         "others the opposite");
    };
    if (first.phase_slots != 0) fail("phase_slots");
    if (!first.from_reference.is_identity())
        fail(config.contains(first.name + ".homography") ? "homography" : "offset_px");
}

void check_shares(const Config& config, const Rig& rig) {
    if (rig.aperture == RigAperture::kOwn) return;
    double sum = 0;
    for (const RigSensor& sensor : rig.sensors) sum += sensor.share;
    if (sum > 1 + kShareRounding)
        throw InputError(
            config.where(rig.sensors.back().name + ".share"),
            fmt::format("the shares have the sum {:.4g}, more than the light of the aperture; "
                        "lower them, or set aperture = \"own\" for cameras side by side",
                        sum));
}

/// The settings of a sensor with its share; at a share of 1 those of the sensor alone.
SensorChoice choice_of(const RigSensor& sensor) {
    SensorChoice choice = sensor.choice;
    if (sensor.share == 1) return choice;
    const double photons = read_sensor_file(choice).params.photons_per_unit * sensor.share;
    choice.settings.push_back(fmt::format("photons_per_unit={}", photons));
    return choice;
}

/// \throws InputError if the map of a sensor makes no sense for frames of this shape.
void check_map(const RigSensor& sensor, FrameShape shape, ColourFilter filter) {
    if (sensor.from_reference.is_identity()) return;
    const auto fail = [&](const char* problem) {
        throw InputError(fmt::format("sensor \"{}\" of the rig", sensor.name), problem);
    };
    if (filter != ColourFilter::kNone)
        fail(
            "is moved, but the footage is a mosaic of colours, which cannot be; give footage in "
            "colour");
    if (!sensor.from_reference.is_finite_on(shape)) fail("maps a pixel of the frame to infinity");
    if (overlap_pixels(sensor.from_reference, shape) == 0)
        fail("sees no pixel of the first sensor; its offset or homography leads out of the frame");
}

/// Planes of the decoded video.
int decoded_planes(const SensorSetup& setup) {
    return setup.params.physical.cfa == ColourFilter::kNone ? setup.shape.planes : 3;
}

void check_like_first(const RigSensor& sensor, const SensorSetup& setup, const SensorSetup& first) {
    const auto fail = [&](const char* what, double value, double of_first) {
        throw InputError(fmt::format("sensor \"{}\" of the rig", sensor.name),
                         fmt::format("has {} {:g}, the first sensor {:g}; they must be equal", what,
                                     value, of_first));
    };
    if (setup.params.slot_us != first.params.slot_us)
        fail("slot_us", setup.params.slot_us, first.params.slot_us);
    if (decoded_planes(setup) != decoded_planes(first))
        fail("planes", decoded_planes(setup), decoded_planes(first));
}

}  // namespace

Rig read_rig(Config& config, const std::string& sensor) {
    Rig rig;
    const KeyReader read(config);
    read({"name", {}, "", "of the rig, for messages"}, rig.name);
    read({"aperture",
          {},
          "",
          "shared: a beam splitter; own: cameras side by side",
          kNamesOf<kApertures>},
         rig.aperture);
    const auto names = read_names(config);
    for (std::size_t i = 0; i < names.size(); ++i)
        rig.sensors.push_back(read_rig_sensor(config, names[i], i, sensor));
    config.reject_unknown_keys();
    check_reference(config, rig.sensors.front());
    check_shares(config, rig);
    return rig;
}

std::vector<SensorSetup> set_up_rig(const Rig& rig, FrameShape footage, ColourFilter filter) {
    std::vector<SensorSetup> setups;
    for (const RigSensor& sensor : rig.sensors) {
        check_map(sensor, footage, filter);
        setups.push_back(set_up_sensor(choice_of(sensor), footage, filter));
        check_like_first(sensor, setups.back(), setups.front());
    }
    return setups;
}

}  // namespace stipple
