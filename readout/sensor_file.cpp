#include "readout/sensor_file.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "core/input_file.h"
#include "core/text.h"
#include "io/footage_files.h"
#include "readout/program/program_text.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/timing/row_loads.h"
#include "sensor_model/sensor_config.h"

namespace stipple {
namespace {

/// \throws InputError for a file without keys, which would be taken for all the defaults.
Config open_config(ConfigKind kind, const std::string& name,
                   const std::vector<std::string>& settings) {
    const auto file = find_config(kind, name);
    Config config(file, settings, kind == ConfigKind::kSensors ? "sensor" : "schedule");
    if (config.file_is_empty())
        throw InputError(file.string(),
                         fmt::format("holds no keys; config/{} has examples", folder_of(kind)));
    return config;
}

Config sensor_config(const SensorChoice& choice) {
    return open_config(ConfigKind::kSensors, choice.sensor, choice.settings);
}

Config schedule_config(const SensorChoice& choice) {
    return open_config(ConfigKind::kSchedules, choice.schedule, choice.schedule_settings);
}

/// The schedule of a stream whose keys are longer is in its header only.
constexpr std::size_t kMaxScheduleKeys = 16384;

/// The name of a sensor or schedule without its folders.
std::string file_name(const std::string& name) {
    return std::filesystem::path(name).filename().string();
}

/// True for a compiled schedule (docs/sequencer_program.md).
bool is_program(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    return extension == ".mem" || extension == ".hex";
}

NamedSchedule read_program(const SensorChoice& choice) {
    if (!choice.schedule_settings.empty())
        throw InputError(Parameter{"schedule." + choice.schedule_settings.front()},
                         fmt::format("{} is a compiled schedule, which has no keys; set them in "
                                     "\"stipple schedule compile\"",
                                     choice.schedule));
    const auto bytes = read_file(choice.schedule);
    const NamedProgram named =
        parse_program({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, choice.schedule);
    return {.name = named.name,
            .source = {},
            .schedule = schedule_of(named.program, choice.schedule),
            .origin = ConfigOrigin{.name = file_name(choice.schedule)}};
}

/// The array that footage of this shape falls on.
FrameShape array_of(const SensorParams& params, FrameShape footage, ColourFilter mosaic) {
    const ColourFilter own = params.physical.cfa;
    if (own == ColourFilter::kNone || own == mosaic) return footage;
    if (mosaic != ColourFilter::kNone)
        throw InputError(
            fmt::format("sensor \"{}\": cfa", params.name),
            fmt::format("its colour filter array begins as {}, the frames as {}; set cfa={}, or "
                        "move the camera's region (OffsetX, OffsetY) by a pixel",
                        name_of(own), name_of(mosaic), name_of(mosaic)));
    if (footage.planes != 3)
        throw InputError(fmt::format("sensor \"{}\": cfa", params.name),
                         fmt::format("a colour filter array ({}) needs colour footage, this has {} "
                                     "plane; set cfa=none",
                                     name_of(params.physical.cfa), footage.planes));
    return {footage.rows, footage.cols, 1};
}

}  // namespace

std::string no_timing_text() {
    std::vector<std::string> timed;
    for (const std::string& name : config_names(ConfigKind::kSensors)) {
        Config config(find_config(ConfigKind::kSensors, name), {});
        if (read_timing(config, 1)) timed.push_back(name);
    }
    return fmt::format("has no section [timing]; these sensors have one: {}", joined(timed));
}

NamedSchedule set_up_schedule(const SensorChoice& choice, FrameShape shape,
                              const ColumnAddressing& addressing) {
    if (is_program(choice.schedule)) return read_program(choice);
    Config config = schedule_config(choice);
    NamedSchedule schedule = read_schedule(config, shape, choice.seed, addressing);
    config.reject_unknown_keys();
    std::string keys = config.as_toml("");
    if (keys.size() > kMaxScheduleKeys) keys.clear();
    schedule.origin = {file_name(choice.schedule), choice.schedule_settings, std::move(keys)};
    return schedule;
}

SensorDescription read_sensor_file(const SensorChoice& choice) {
    Config config = sensor_config(choice);
    SensorDescription sensor{.params = read_sensor(config)};
    sensor.timing = read_timing(config, sensor.params.bit_depth);
    config.reject_unknown_keys();
    sensor.origin = {file_name(choice.sensor), choice.settings, config.as_toml("")};
    return sensor;
}

SensorParams set_up_params(const SensorChoice& choice) {
    return read_sensor_file(choice).params;
}

SensorSetup set_up_sensor(const SensorChoice& choice, FrameShape footage, ColourFilter mosaic) {
    return set_up_sensor(read_sensor_file(choice), choice, footage, mosaic);
}

SensorSetup set_up_sensor(const SensorDescription& sensor, const SensorChoice& choice,
                          FrameShape footage, ColourFilter mosaic) {
    const FrameShape shape = array_of(sensor.params, footage, mosaic);
    if (sensor.timing) check_window(*sensor.timing, shape);
    if (!sensor.timing && choice.overrun == OverrunPolicy::kDrop)
        throw InputError(Parameter{"overrun", "drop"},
                         fmt::format("sensor \"{}\" {}", sensor.params.name, no_timing_text()));
    const ColumnAddressing addressing =
        sensor.timing ? sensor.timing->addressing : ColumnAddressing{};
    return {.params = sensor.params,
            .schedule = set_up_schedule(choice, shape, addressing),
            .shape = shape,
            .footage = footage,
            .seed = choice.seed,
            .timing = sensor.timing,
            .overrun = choice.overrun,
            .origin = sensor.origin};
}

std::string mosaic_warning(const SensorSetup& setup, ColourFilter mosaic) {
    if (mosaic == ColourFilter::kNone || setup.params.physical.cfa != ColourFilter::kNone)
        return {};
    return fmt::format(
        "the frames are a mosaic of colours ({}), but sensor \"{}\" has no colour filter array: "
        "they are taken for grey, and decoding smooths over their pattern. A sensor of mode "
        "\"physical\" with cfa={}, such as \"ideal\", gives colour",
        name_of(mosaic), setup.params.name, name_of(mosaic));
}

}  // namespace stipple
