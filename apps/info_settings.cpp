#include "apps/info.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <vector>

#include "apps/key_list.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "apps/standard_streams.h"
#include "core/config.h"
#include "core/error.h"
#include "core/text.h"
#include "io/footage_files.h"
#include "readout/schedule_feasibility.h"
#include "readout/sensor_file.h"
#include "sensor_model/sensor_keys.h"
#include "study/report/schedule_text.h"
#include "study/scenes/scene.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Of a schedule that is shown without a sensor.
constexpr FrameShape kArray{.rows = 480, .cols = 640, .planes = 1};

bool is_listed(ConfigKind kind, const std::string& name) {
    return std::ranges::count(config_names(kind), name) > 0;
}

bool is_scene(const std::string& name) {
    return std::ranges::find(scenes(), name, &NamedScene::name) != scenes().end();
}

SettingsKind kind_of_name(const std::string& name) {
    const bool sensor = is_listed(ConfigKind::kSensors, name);
    const bool schedule = is_listed(ConfigKind::kSchedules, name);
    if (sensor && schedule)
        throw InputError(fmt::format("\"{}\"", name),
                         fmt::format("is the name of a sensor and of a schedule; give the file: "
                                     "{} or {}",
                                     find_config(ConfigKind::kSensors, name).string(),
                                     find_config(ConfigKind::kSchedules, name).string()));
    if (sensor) return SettingsKind::kSensor;
    if (schedule) return SettingsKind::kSchedule;
    if (is_listed(ConfigKind::kRigs, name)) return SettingsKind::kRig;
    if (is_listed(ConfigKind::kSpaces, name)) return SettingsKind::kSpace;
    return is_scene(name) ? SettingsKind::kScene : SettingsKind::kNone;
}

SettingsKind kind_of_keys(const std::string& file) {
    const Config config(file, {});
    if (config.contains("kind")) return SettingsKind::kSchedule;
    if (config.contains("sensors")) return SettingsKind::kRig;
    if (config.contains("systems") || !config.as_toml("axes").empty()) return SettingsKind::kSpace;
    for (const KeyList& list : key_lists("sensor", ""))
        for (const KnownKey& key : list.keys)
            if (config.contains(key.name)) return SettingsKind::kSensor;
    throw InputError(
        file,
        "holds the keys of neither a sensor nor a schedule (\"stipple list keys\"), nor "
        "of a rig or a space of explore");
}

/// The values of the keys with their units, as if they were the defaults of a file without keys.
std::vector<KnownKey> values_of(SensorParams params) {
    Config none(std::vector<std::string>{});
    visit_sensor_keys(params, KeyReader(none));
    if (params.mode == SensorMode::kPhysical) visit_physical_keys(params.physical, KeyReader(none));
    return none.known_keys();
}

/// What follows from the keys.
std::vector<KnownKey> derived_from(const SensorParams& params) {
    const auto row = [](const char* name, double value, const char* unit, const char* text) {
        return KnownKey{name, fmt::format("{:.6g}", value), "", unit, text};
    };
    return {row("gain_e_per_dn", params.gain_e_per_dn(), "electrons/DN", "K: system gain"),
            row("electrons_per_unit", params.electrons_per_unit(), "electrons",
                "mean of flux 1.0 in a slot"),
            row("dark_e_per_slot", params.dark_e_per_slot(), "electrons", "mean dark charge"),
            row("saturation_e", params.saturation_e(), "electrons",
                "light that fills the well or the converter"),
            row("temporal_read_noise_e", params.temporal_read_noise_e(), "electrons",
                "temporal noise of one reading")};
}

/// A number in its shortest form, else `text` as it is.
std::string short_number(const std::string& text) {
    const auto number = parsed_number<double>(text);
    return number ? fmt::format("{}", *number) : text;
}

/// The keys of the section [timing] that the file gives.
std::vector<KnownKey> timing_of(const std::string& file) {
    const std::vector<KnownKey> known = key_lists("sensor", "timing").front().keys;
    std::istringstream lines(Config(file, {}).as_toml("timing"));
    std::vector<KnownKey> rows;
    for (std::string line; std::getline(lines, line);) {
        const auto equals = line.find(" = ");
        if (equals == std::string::npos) continue;
        const std::string name = line.substr(0, equals);
        const auto key = std::ranges::find(known, "timing." + name, &KnownKey::name);
        rows.push_back({name, short_number(line.substr(equals + 3)), "",
                        key == known.end() ? "" : key->unit, key == known.end() ? "" : key->text});
    }
    return rows;
}

ordered_json rows_json(const std::vector<KnownKey>& rows) {
    auto json = ordered_json::array();
    for (const KnownKey& row : rows)
        json.push_back(
            {{"name", row.name}, {"value", row.fallback}, {"unit", row.unit}, {"text", row.text}});
    return json;
}

std::string rows_text(const std::vector<KnownKey>& rows) {
    constexpr std::size_t kMaxWidth = 12;
    const std::size_t name_width = column_width(rows, &KnownKey::name);
    const std::size_t value_width = column_width(rows, &KnownKey::fallback, kMaxWidth);
    std::string text;
    for (const KnownKey& row : rows)
        text += fmt::format("\n  {:<{}}  {:>{}} {:<12}  {}", row.name, name_width, row.fallback,
                            value_width, row.unit, row.text);
    return text;
}

void info_sensor(const std::string& name, const RunOptions& run) {
    const SensorChoice choice{.sensor = name};
    const SensorDescription sensor = read_sensor_file(choice);
    const std::string file = find_config(ConfigKind::kSensors, name).string();
    const auto keys = values_of(sensor.params);
    const auto derived = derived_from(sensor.params);
    JsonFile json(run);
    ordered_json figures{
        {"kind", "sensor"},        {"name", sensor.params.name},    {"file", file},
        {"keys", rows_json(keys)}, {"derived", rows_json(derived)}, {"timing", nullptr}};
    std::string text = fmt::format("sensor       {} ({}){}\nderived{}", sensor.params.name, file,
                                   rows_text(keys), rows_text(derived));
    if (sensor.timing) {
        const ReadoutTiming& timing = *sensor.timing;
        const auto given = timing_of(file);
        figures["timing"] = {{"width", timing.cols},
                             {"height", timing.rows},
                             {"clock_hz", timing.clock_hz},
                             {"adcs", timing.adcs()},
                             {"hypothetical", timing.hypothetical},
                             {"keys", rows_json(given)}};
        text += fmt::format(
            "\ntiming       {} x {} pixels (width x height), {:.6g} MHz; rates: stipple timing "
            "--sensor {}{}",
            timing.cols, timing.rows, static_cast<double>(timing.clock_hz) * 1e-6, name,
            rows_text(given));
    } else {
        text += "\ntiming       none: no limits of a readout";
    }
    json.write(figures);
    run.say(text);
}

/// Whether a sensor can do a schedule with its whole array.
struct Verdict {
    std::string sensor;
    std::string problem;  ///< empty: it can
};

std::string problem_of(const std::string& sensor_name, const std::string& schedule_name) {
    try {
        const SensorChoice choice{.sensor = sensor_name, .schedule = schedule_name};
        const SensorDescription sensor = read_sensor_file(choice);
        FrameShape shape = kArray;
        if (sensor.timing)
            shape = {.rows = sensor.timing->rows, .cols = sensor.timing->cols, .planes = 1};
        if (sensor.params.physical.cfa != ColourFilter::kNone) shape.planes = 3;
        return schedule_problem(set_up_sensor(sensor, choice, shape)).value_or("");
    } catch (const InputError& e) {
        return e.message().text(in_options);
    }
}

std::string verdicts_text(const std::vector<Verdict>& verdicts) {
    std::vector<std::string> able;
    std::string others;
    for (const Verdict& verdict : verdicts)
        if (verdict.problem.empty())
            able.push_back(verdict.sensor);
        else
            others += fmt::format("\n  {:<12} {}", verdict.sensor, verdict.problem);
    return fmt::format("sensors that can do it with their whole array: {}{}{}",
                       able.empty() ? "none" : joined(able),
                       others.empty() ? "" : "\nsensors that cannot:", others);
}

/// The key `kind` of its file.
std::string kind_key(const std::string& name) {
    const std::string extension = lower_extension(name);
    if (extension == ".mem" || extension == ".hex") return "compiled";
    return Config(find_config(ConfigKind::kSchedules, name), {}).text({"kind"}, "");
}

void info_schedule(const std::string& name, const RunOptions& run) {
    const NamedSchedule named =
        set_up_schedule(SensorChoice{.schedule = name}, kArray, ColumnAddressing{});
    JsonFile json(run);
    const ScheduleFigures figures = schedule_figures(named.schedule, kArray);
    std::vector<Verdict> verdicts;
    for (const std::string& sensor : config_names(ConfigKind::kSensors))
        verdicts.push_back({sensor, problem_of(sensor, name)});
    const std::string kind = kind_key(name);
    ordered_json told{{"kind", "schedule"}, {"schedule_kind", kind}};
    told.update(figures_json(named.name, figures));
    told["array"] = {{"width", kArray.cols}, {"height", kArray.rows}};
    told["sensors"] = ordered_json::array();
    for (const Verdict& verdict : verdicts)
        told["sensors"].push_back({{"sensor", verdict.sensor},
                                   {"legal", verdict.problem.empty()},
                                   {"problem", verdict.problem}});
    json.write(told);
    run.say(fmt::format("schedule of kind {}, of an array of {} x {}\n{}\n{}", kind, kArray.cols,
                        kArray.rows, figures_text(named.name, figures), verdicts_text(verdicts)));
}

void info_scene(const std::string& name, const RunOptions& run) {
    const auto scene = std::ranges::find(scenes(), name, &NamedScene::name);
    const SceneOptions options;
    JsonFile json(run);
    json.write({{"kind", "scene"},
                {"name", name},
                {"text", scene->text},
                {"width", options.shape.cols},
                {"height", options.shape.rows},
                {"planes", options.shape.planes},
                {"frames", options.slots}});
    run.say(
        fmt::format("scene        {}: {}\n"
                    "frames       {} x {} x {} (width x height x planes), {} of them, linear "
                    "light; stipple synth {} --size WxH --frames N",
                    name, scene->text, options.shape.cols, options.shape.rows, options.shape.planes,
                    options.slots, name));
}

}  // namespace

SettingsKind settings_kind(const std::string& name) {
    std::error_code error;
    if (!fs::exists(name, error)) return kind_of_name(name);
    const std::string extension = lower_extension(name);
    if (extension == ".mem" || extension == ".hex") return SettingsKind::kSchedule;
    return extension == ".toml" ? kind_of_keys(name) : SettingsKind::kNone;
}

void info_settings(SettingsKind kind, const std::string& name, const RunOptions& run) {
    if (kind == SettingsKind::kSensor) info_sensor(name, run);
    if (kind == SettingsKind::kSchedule) info_schedule(name, run);
    if (kind == SettingsKind::kScene) info_scene(name, run);
    if (kind == SettingsKind::kRig) info_rig_file(name, run);
    if (kind == SettingsKind::kSpace) info_space(name, run);
}

}  // namespace stipple
