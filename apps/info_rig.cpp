#include "apps/info.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "apps/interrupt.h"
#include "apps/output/json_file.h"
#include "apps/output/text_layout.h"
#include "core/config.h"
#include "core/error.h"
#include "core/text.h"
#include "session/rig_folder.h"
#include "stream/stream_figures.h"

namespace stipple {
namespace {

using nlohmann::ordered_json;

/// ", 3 slots later, moved by (1, -2) pixels" and so on; empty for a sensor like the first.
std::string view_text(const RigSensor& sensor) {
    std::string text;
    if (sensor.phase_slots != 0)
        text += fmt::format(", {} later", counted(sensor.phase_slots, "slot"));
    const auto& m = sensor.from_reference.matrix();
    if (sensor.from_reference == Homography::shift({m[5], m[2]})) {
        if (!sensor.from_reference.is_identity())
            text += fmt::format(", moved by ({:g}, {:g}) pixels (row, col)", m[5], m[2]);
    } else {
        text += ", with a homography";
    }
    return text;
}

/// The keys that differ from the files of the sensor and the schedule, as --set takes them.
std::vector<std::string> settings_of(const RigSensor& sensor) {
    std::vector<std::string> settings;
    for (const std::string& key : sensor.choice.settings) settings.push_back("sensor." + key);
    for (const std::string& key : sensor.choice.schedule_settings)
        settings.push_back("schedule." + key);
    return settings;
}

ordered_json sensor_json(const RigSensor& sensor) {
    return {{"name", sensor.name},
            {"sensor", sensor.choice.sensor},
            {"schedule", sensor.choice.schedule},
            {"set", settings_of(sensor)},
            {"share", sensor.share},
            {"phase_slots", sensor.phase_slots},
            {"homography", sensor.from_reference.matrix()}};
}

std::string sensor_text(const RigSensor& sensor) {
    const std::vector<std::string> settings = settings_of(sensor);
    return fmt::format("{}: {:g} % of the light, sensor {}, schedule {}{}{}{}", sensor.name,
                       100 * sensor.share, sensor.choice.sensor, sensor.choice.schedule,
                       settings.empty() ? "" : " with ", joined(settings), view_text(sensor));
}

std::string rig_text(const Rig& rig) {
    return fmt::format("rig          {}{}, {}", rig.name, rig.name.empty() ? "unnamed" : "",
                       rig.aperture == RigAperture::kShared ? "one aperture that is shared"
                                                            : "an aperture for each sensor");
}

/// Reads a stream to its end. \throws InputError if it is damaged.
void read_all(StreamReader& reader) {
    SamplePacket packet;
    while (reader.next(packet)) throw_if_stopped();
    if (!undamaged(reader.report())) throw InputError(reader.name(), damage_text(reader.report()));
}

/// Sums over the streams of a rig.
struct StreamTotals {
    double light_collected = 0;
    double bits_per_slot = 0;
    double bits_per_second = 0;

    void add(const StreamReader& reader, double share) {
        const StreamReport& report = reader.report();
        const double bits = static_cast<double>(report.payload_bits) /
                            static_cast<double>(std::max<std::int64_t>(report.slots, 1));
        light_collected += share * reader.header().schedule.light_throughput();
        bits_per_slot += bits;
        bits_per_second += bits / (reader.header().slot_us * 1e-6);
    }
};

}  // namespace

void info_rig(const std::string& folder, const RunOptions& run) {
    RigFolder opened = open_rig_folder(folder, ReadPolicy::kCounts, [] { throw_if_stopped(); });
    JsonFile json(run);
    ordered_json figures{{"kind", "rig"}, {"name", opened.rig.name}, {"sensors", {}}};
    StreamTotals totals;
    std::string text = rig_text(opened.rig);
    for (std::size_t i = 0; i < opened.readers.size(); ++i) {
        StreamReader& reader = opened.readers[i];
        const RigSensor& sensor = opened.rig.sensors[i];
        read_all(reader);
        totals.add(reader, sensor.share);
        ordered_json own = sensor_json(sensor);
        own["slots"] = reader.report().slots;
        own["samples"] = reader.report().samples;
        own["payload_bits"] = reader.report().payload_bits;
        own["light_throughput"] = reader.header().schedule.light_throughput();
        figures["sensors"].push_back(own);
        text += fmt::format("\n  {}, {}, {}", sensor_text(sensor),
                            counted(reader.report().slots, "slot"),
                            counted(reader.report().samples, "sample"));
    }
    figures["light_collected"] = totals.light_collected;
    figures["bits_per_slot"] = totals.bits_per_slot;
    figures["bits_per_second"] = totals.bits_per_second;
    json.write(figures);
    run.say(
        fmt::format("{}\ntotal        {:.1f} % of the light of an aperture collected, {} bits "
                    "a slot, {} Mbit/s",
                    text, 100 * totals.light_collected, rounded(totals.bits_per_slot),
                    rounded(totals.bits_per_second * 1e-6)));
}

void info_rig_file(const std::string& name, const RunOptions& run) {
    Config config(find_config(ConfigKind::kRigs, name), {});
    const Rig rig = read_rig(config);
    JsonFile json(run);
    ordered_json figures{{"kind", "rig"}, {"name", rig.name}, {"sensors", {}}};
    std::string text = rig_text(rig);
    for (const RigSensor& sensor : rig.sensors) {
        figures["sensors"].push_back(sensor_json(sensor));
        text += fmt::format("\n  {}", sensor_text(sensor));
    }
    json.write(figures);
    run.say(text);
}

}  // namespace stipple
