#include "readout/provenance.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <sstream>
#include <string_view>
#include <type_traits>
#include <utility>

#include "core/config.h"
#include "core/text.h"
#include "core/version.h"
#include "readout/sensor_file.h"
#include "sensor_model/sensor_keys.h"
#include "stream/plain_text.h"

namespace stipple {
namespace {

toml::array toml_array(const std::vector<double>& values) {
    toml::array array;
    for (const double value : values) array.push_back(value);
    return array;
}

/// Key of a sensor or schedule without a file.
constexpr std::string_view kMadeInCode = "made_in_code";

toml::table keys_of(const std::optional<ConfigOrigin>& origin) {
    return origin ? toml::parse(origin->keys) : toml::table();
}

/// All parameters of the sensor's mode, as in a file of config/sensors, and the keys of its timing.
toml::table sensor_table(const SensorSetup& setup) {
    const SensorParams& params = setup.params;
    toml::table sensor;
    const auto add = [&](const ConfigKey& key, const auto& value) {
        using Value = std::remove_cvref_t<decltype(value)>;
        if constexpr (std::is_enum_v<Value>)
            sensor.insert(key.name, key.choices[static_cast<std::size_t>(value)]);
        else if constexpr (std::is_same_v<Value, std::vector<double>>)
            sensor.insert(key.name, toml_array(value));
        else if constexpr (std::is_same_v<Value, std::uint32_t>)
            sensor.insert(key.name, std::int64_t{value});
        else
            sensor.insert(key.name, value);
    };
    visit_sensor_keys(params, add);
    if (params.mode == SensorMode::kPhysical) visit_physical_keys(params.physical, add);
    const toml::table keys = keys_of(setup.origin);
    if (const toml::table* timing = keys["timing"].as_table(); timing != nullptr && setup.timing)
        sensor.insert("timing", *timing);
    if (!setup.origin) sensor.insert(kMadeInCode, true);
    return sensor;
}

toml::table footage_table(const FootageOrigin& footage) {
    toml::table table{{"name", footage.name},
                      {"transfer", name_of(footage.reading.transfer.value_or(Transfer::kLinear))},
                      {"luminance", footage.reading.luminance}};
    if (!footage.sha256.empty()) table.insert("sha256", footage.sha256);
    if (!footage.recording.empty()) table.insert("recording", footage.recording);
    if (footage.reading.raw) table.insert("raw", footage.reading.raw->text);
    if (!footage.pixel_format.empty()) table.insert("pixel_format", footage.pixel_format);
    if (footage.reading.min_value) table.insert("min_value", *footage.reading.min_value);
    if (footage.reading.max_value) table.insert("max_value", *footage.reading.max_value);
    const FootagePart& part = footage.reading.part;
    if (part.frames != FrameRange()) table.insert("frames", text_of(part.frames));
    if (part.crop) table.insert("crop", text_of(*part.crop));
    if (part.bin != 1) table.insert("bin", part.bin);
    if (part.size) table.insert("resize", text_of(CropArea{part.size->rows, part.size->cols}));
    if (footage.reading.scale != 1) table.insert("scale", footage.reading.scale);
    if (!footage.resample.empty()) table.insert("resample", footage.resample);
    if (footage.reading.frames_hz) table.insert("frames_hz", *footage.reading.frames_hz);
    if (footage.black_level_dn != 0) table.insert("black_level_dn", footage.black_level_dn);
    return table;
}

/// The options of `emulate` that name the files of sensor and schedule, and change their keys.
toml::table options_table(const SensorSetup& setup, const std::vector<std::string>& switches) {
    toml::table options;
    toml::array settings;
    const auto add = [&](const std::string& option, const std::optional<ConfigOrigin>& origin) {
        if (!origin) return;
        options.insert(option, origin->name);
        for (const std::string& setting : origin->settings)
            settings.push_back(fmt::format("{}.{}", option, setting));
    };
    add("sensor", setup.origin);
    add("schedule", setup.schedule.origin);
    options.insert("set", settings);
    if (switches.empty()) return options;
    toml::array texts;
    for (const std::string& text : switches) texts.push_back(text);
    options.insert("switch", texts);
    return options;
}

toml::table schedule_table(const NamedSchedule& schedule) {
    toml::table table = keys_of(schedule.origin);
    table.insert_or_assign("name", schedule.name);
    if (!schedule.origin) table.insert(kMadeInCode, true);
    return table;
}

std::string text_of(const toml::node_view<const toml::node>& node) {
    return node.value<std::string>().value_or("");
}

/// The options of the footage that differ from their defaults.
std::string footage_options(const toml::node_view<const toml::node>& footage) {
    std::string text;
    const auto add = [&](std::string_view option, const std::string& value) {
        text += fmt::format(" {} {}", option, shell_quoted(value));
    };
    if (const auto it = text_of(footage["transfer"]); it != "linear") add("--transfer", it);
    if (const auto it = text_of(footage["raw"]); !it.empty()) add("--raw", it);
    if (footage["luminance"].value_or(false)) text += " --luminance";
    for (const char* key : {"frames", "crop", "resize"})
        if (const auto it = text_of(footage[key]); !it.empty()) add(fmt::format("--{}", key), it);
    if (const auto bin = footage["bin"].value<std::int64_t>()) add("--bin", std::to_string(*bin));
    if (const auto scale = footage["scale"].value<double>())
        add("--scale", fmt::format("{}", *scale));
    if (const auto it = text_of(footage["resample"]); !it.empty()) add("--resample", it);
    if (const auto hz = footage["frames_hz"].value<double>())
        add("--frames-hz", fmt::format("{}", *hz));
    if (const auto min_value = footage["min_value"].value<double>())
        add("--min-value", fmt::format("{}", *min_value));
    if (const auto max_value = footage["max_value"].value<double>())
        add("--max-value", fmt::format("{}", *max_value));
    return text;
}

/// The options of a command that differ from their defaults.
std::string options_of(const toml::table& provenance) {
    const auto options = provenance["options"];
    std::string text = footage_options(provenance["footage"]);
    const auto add = [&](std::string_view option, const std::string& value) {
        text += fmt::format(" {} {}", option, shell_quoted(value));
    };
    const SensorChoice defaults;
    if (const auto it = text_of(options["sensor"]); it != defaults.sensor) add("--sensor", it);
    if (const auto it = text_of(options["schedule"]); it != defaults.schedule)
        add("--schedule", it);
    for (const char* const list : {"set", "switch"})
        if (const auto* settings = options[list].as_array())
            for (const toml::node& setting : *settings)
                add(fmt::format("--{}", list), setting.value<std::string>().value_or(""));
    const auto seed = provenance["seed"];
    const auto number = seed.value_exact<std::int64_t>();  // not of floating point
    if (const auto it = number ? std::to_string(*number) : text_of(seed); it != "1")
        add("--seed", it);
    if (const auto it = text_of(provenance["overrun"]); it != "stretch") add("--overrun", it);
    return text;
}

/// What a header tells; empty if it is no TOML, or has keys that are too long to be parsed safely.
toml::table table_of(const std::string& provenance) {
    try {
        if (line_of_long_key(provenance) == 0) return toml::parse(provenance);
    } catch (const toml::parse_error&) {
        // A text for people.
    }
    return {};
}

}  // namespace

std::string provenance_of(const SensorSetup& setup, const FootageOrigin& footage,
                          const std::vector<std::string>& switches) {
    toml::table text{
        {"emulator", fmt::format("stipple {}", version())}, {"footage", footage_table(footage)},
        {"options", options_table(setup, switches)},        {"overrun", name_of(setup.overrun)},
        {"schedule", schedule_table(setup.schedule)},       {"sensor", sensor_table(setup)}};
    // TOML integers are signed, seeds are not.
    if (setup.seed <= std::numeric_limits<std::int64_t>::max())
        text.insert("seed", static_cast<std::int64_t>(setup.seed));
    else
        text.insert("seed", std::to_string(setup.seed));
    std::ostringstream stream;
    stream.exceptions(std::ios::badbit);  // else it ends early where there is no memory
    stream << text << '\n';
    return stream.str();
}

std::string command_of(const std::string& provenance) {
    const toml::table table = table_of(provenance);
    const auto footage = table["footage"];
    std::string name = text_of(footage["name"]);
    const auto options = table["options"];
    // `emulate` has no options for a camera, its pixel format and its black level.
    if (name.empty() || !footage["sha256"] || footage["pixel_format"] ||
        footage["black_level_dn"] || !options["sensor"] || !options["schedule"])
        return {};
    if (name.starts_with('-')) name.insert(0, "./");
    std::string command =
        fmt::format("stipple emulate {} -o again.stipple{}", shell_quoted(name), options_of(table));
    if (!is_plain_text(command, false)) command.clear();
    return command;
}

std::string options_of(const FootageOptions& reading) {
    const toml::table table{{"footage", footage_table({.reading = reading})}};
    return footage_options(std::as_const(table)["footage"]);
}

std::string footage_of(const std::string& provenance) {
    const toml::table table = table_of(provenance);
    const auto* footage = table["footage"].as_table();
    if (footage == nullptr) return {};
    std::ostringstream text;
    text.exceptions(std::ios::badbit);
    text << *footage;
    return text.str();
}

ChipOrigin chip_of(const std::string& provenance) {
    const toml::table table = table_of(provenance);
    const auto sensor = table["sensor"];
    const auto number = [&](std::string_view key) { return sensor[key].value_or(0.0); };
    ChipOrigin chip{.name = text_of(sensor["name"]),
                    .prnu = number("prnu"),
                    .dsnu_e = number("dsnu_e"),
                    .column_noise_e = number("column_noise_e"),
                    .response_loss = number("response_loss")};
    const auto device_id = sensor["device_id"].value_exact<std::int64_t>();
    if (device_id && *device_id >= 0 && *device_id <= std::numeric_limits<std::uint32_t>::max())
        chip.device_id = static_cast<std::uint32_t>(*device_id);
    return chip;
}

std::vector<std::string> timing_settings(const std::string& provenance) {
    std::vector<std::string> settings;
    const toml::table table = table_of(provenance);
    if (const auto* timing = table["sensor"]["timing"].as_table())
        for (const auto& [key, node] : *timing) {
            std::ostringstream setting;
            setting.exceptions(std::ios::badbit);
            setting << "timing." << key.str() << '=';
            node.visit([&](const auto& value) { setting << value; });
            settings.push_back(setting.str());
        }
    return settings;
}

}  // namespace stipple
