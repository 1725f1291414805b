#include "apps/sensor_setup.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>
#include <sstream>
#include <string_view>
#include <utility>

#include "core/config.h"
#include "core/error.h"
#include "core/input_file.h"
#include "readout/program_text.h"
#include "sensor_model/physical_keys.h"
#include "sensor_model/sensor_config.h"

namespace stipple {
namespace {

/// The settings whose key begins with `section` (empty: with none of the sections), without it.
std::vector<std::string> settings_of(const SensorChoice& choice, std::string_view section) {
    constexpr std::string_view kSchedule = "schedule.";
    std::vector<std::string> settings;
    for (const std::string& setting : choice.settings)
        if (setting.starts_with(kSchedule) == (section == kSchedule))
            settings.push_back(setting.substr(section.size()));
    return settings;
}

/// True for a compiled schedule (docs/sequencer_program.md).
bool is_program(const std::filesystem::path& file) {
    return file.extension() == ".mem" || file.extension() == ".hex";
}

NamedSchedule read_program(const SensorChoice& choice) {
    const auto settings = settings_of(choice, "schedule.");
    if (!settings.empty())
        throw InputError("--set schedule." + settings.front(),
                         fmt::format("{} is a compiled schedule, which has no keys; set them in "
                                     "`stipple schedule compile`",
                                     choice.schedule));
    const auto bytes = read_file(choice.schedule);
    const NamedProgram named =
        parse_program({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, choice.schedule);
    return {
        .name = named.name, .source = {}, .schedule = schedule_of(named.program, choice.schedule)};
}

toml::array toml_array(const std::vector<double>& values) {
    toml::array array;
    for (const double value : values) array.push_back(value);
    return array;
}

void add_physical_terms(const PhysicalTerms& terms, toml::table& sensor) {
    for (const PhysicalKey& key : kPhysicalKeys) sensor.insert(key.name, terms.*key.term);
    sensor.insert("row_noise_e", toml_array(terms.row_noise_e));
    sensor.insert("device_id", std::int64_t{terms.device_id});
    sensor.insert("cfa", name_of(terms.cfa));
    sensor.insert("map_rows", terms.map_rows);
    sensor.insert("map_cols", terms.map_cols);
    sensor.insert("transmittance", toml_array(terms.transmittance));
    sensor.insert("gain_map", toml_array(terms.gain_map));
}

/// All parameters of the sensor's mode, as in a file of config/sensors.
toml::table sensor_table(const SensorParams& params) {
    const bool physical = params.mode == SensorMode::kPhysical;
    toml::table sensor{{"mode", physical ? "physical" : "paper"},
                       {"name", params.name},
                       {"photons_per_unit", params.photons_per_unit},
                       {"full_scale_e", params.full_scale_e},
                       {"full_well_e", params.full_well_e},
                       {"read_noise_e", params.read_noise_e},
                       {"shot_noise", params.shot_noise},
                       {"bit_depth", params.bit_depth},
                       {"rounding", params.rounding == AdcRounding::kFloor ? "floor" : "nearest"},
                       {"slot_us", params.slot_us},
                       {"charge_stores", params.charge_stores}};
    if (physical) add_physical_terms(params.physical, sensor);
    return sensor;
}

/// The array that footage of this shape falls on.
FrameShape array_of(const SensorParams& params, FrameShape footage, ColourFilter mosaic) {
    const ColourFilter own = params.physical.cfa;
    if (own == ColourFilter::kNone || own == mosaic) return footage;
    if (mosaic != ColourFilter::kNone)
        throw InputError(
            fmt::format("sensor '{}': cfa", params.name),
            fmt::format("its colour filter array begins as {}, the frames as {}; set cfa={}, or "
                        "move the camera's region (OffsetX, OffsetY) by a pixel",
                        name_of(own), name_of(mosaic), name_of(mosaic)));
    if (footage.planes != 3)
        throw InputError(fmt::format("sensor '{}': cfa", params.name),
                         fmt::format("a colour filter array ({}) needs colour footage, this has {} "
                                     "plane; set cfa=none",
                                     name_of(params.physical.cfa), footage.planes));
    return {footage.rows, footage.cols, 1};
}

/// \throws InputError for a file without keys, which would be taken for all the defaults.
Config open_config(std::string_view kind, const std::string& name,
                   const std::vector<std::string>& settings) {
    const auto file = find_config(kind, name);
    Config config(file, settings);
    if (config.file_is_empty())
        throw InputError(file.string(), fmt::format("holds no keys; config/{} has examples", kind));
    return config;
}

}  // namespace

NamedSchedule set_up_schedule(const SensorChoice& choice, FrameShape shape,
                              const ColumnAddressing& addressing) {
    if (is_program(choice.schedule)) return read_program(choice);
    Config config = open_config("schedules", choice.schedule, settings_of(choice, "schedule."));
    NamedSchedule schedule = read_schedule(config, shape, choice.seed, addressing);
    config.reject_unknown_keys();
    return schedule;
}

SensorDescription read_sensor_file(const SensorChoice& choice) {
    Config config = open_config("sensors", choice.sensor, settings_of(choice, ""));
    SensorDescription sensor{.params = read_sensor(config), .timing = {}};
    sensor.timing = read_timing(config, sensor.params.bit_depth);
    config.reject_unknown_keys();
    return sensor;
}

SensorParams set_up_params(const SensorChoice& choice) {
    const auto settings = settings_of(choice, "schedule.");
    if (!settings.empty())
        throw InputError("--set schedule." + settings.front(), "there is no schedule here");
    return read_sensor_file(choice).params;
}

SensorSetup set_up_sensor(const SensorChoice& choice, FrameShape footage, ColourFilter mosaic) {
    const SensorDescription sensor = read_sensor_file(choice);
    const FrameShape shape = array_of(sensor.params, footage, mosaic);
    if (sensor.timing) check_window(*sensor.timing, shape);
    if (!sensor.timing && choice.overrun == OverrunPolicy::kDrop)
        throw InputError("--overrun drop",
                         fmt::format("the sensor '{}' has no section [timing], so nothing exceeds "
                                     "a slot; `stipple timing` lists those that have one",
                                     sensor.params.name));
    const ColumnAddressing addressing =
        sensor.timing ? sensor.timing->addressing : ColumnAddressing{};
    return {.params = sensor.params,
            .schedule = set_up_schedule(choice, shape, addressing),
            .shape = shape,
            .footage = footage,
            .seed = choice.seed,
            .timing = sensor.timing,
            .overrun = choice.overrun};
}

std::string mosaic_warning(const SensorSetup& setup, ColourFilter mosaic) {
    if (mosaic == ColourFilter::kNone || setup.params.physical.cfa != ColourFilter::kNone)
        return {};
    return fmt::format(
        "the frames are a mosaic of colours ({}), but sensor '{}' has no colour filter array: they "
        "are taken for grey, and decoding smooths over their pattern. A sensor of mode "
        "\"physical\" "
        "with cfa={}, such as `ideal`, gives colour",
        name_of(mosaic), setup.params.name, name_of(mosaic));
}

std::string provenance_of(const SensorSetup& setup, const std::string& footage) {
    const toml::table sensor = sensor_table(setup.params);
    const toml::table text{{"emulator", "stipple " STIPPLE_VERSION},
                           {"footage", footage},
                           {"schedule", setup.schedule.name},
                           // TOML integers are signed, seeds are not.
                           {"seed", std::to_string(setup.seed)},
                           {"sensor", sensor}};
    std::ostringstream stream;
    stream << text << '\n';
    return stream.str();
}

}  // namespace stipple
