#include "apps/key_list.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/arguments/command_line.h"
#include "core/config.h"
#include "core/text.h"
#include "decoder/decode_options.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/sensor_file.h"
#include "readout/timing/readout_timing.h"
#include "sensor_model/sensor_config.h"

namespace stipple {
namespace {

std::vector<KnownKey> sensor_keys(const std::string& mode) {
    Config config({"mode=" + mode});
    static_cast<void>(read_sensor(config));
    return config.known_keys();
}

std::vector<KnownKey> timing_keys() {
    Config config(std::vector<std::string>{});
    static_cast<void>(read_timing(config, 1));
    return config.known_keys();
}

std::vector<KnownKey> decoder_keys(DecodeMethod method) {
    Config config(std::vector<std::string>{});
    static_cast<void>(read_decode_options(method, config));
    return config.known_keys();
}

std::vector<KeyList> all_key_lists() {
    const auto paper = sensor_keys("paper");
    auto physical = sensor_keys("physical");
    std::erase_if(physical, [&](const KnownKey& key) {
        return std::ranges::find(paper, key.name, &KnownKey::name) != paper.end();
    });
    std::vector<KeyList> lists{{"sensor", "paper", paper},
                               {"sensor", "physical", std::move(physical)},
                               {"sensor", "timing", timing_keys()}};
    for (const std::string_view kind : schedule_kinds())
        lists.push_back({"schedule", std::string(kind), known_schedule_keys(kind)});
    for (const NamedDecodeMethod& method : decode_methods())
        lists.push_back({"decoder", std::string(method.name), decoder_keys(method.method)});
    return lists;
}

/// The lists of keys that a sensor takes; for another name that itself.
std::vector<std::string> lists_of(const std::string& of) {
    const auto sensors = config_names(ConfigKind::kSensors);
    if (std::ranges::find(sensors, of) == sensors.end()) return {of};
    if (set_up_params({.sensor = of}).mode == SensorMode::kPaper) return {"paper", "timing"};
    return {"paper", "physical", "timing"};
}

}  // namespace

std::vector<KeyList> key_lists(const std::string& section, const std::string& of) {
    auto lists = all_key_lists();
    std::erase_if(lists,
                  [&](const KeyList& list) { return !section.empty() && list.section != section; });
    std::vector<std::string> names;
    names.reserve(lists.size());
    for (const KeyList& list : lists) names.push_back(list.of);
    if (!of.empty()) {
        const bool is_list = std::ranges::find(names, of) != names.end();
        const auto wanted = is_list ? std::vector{of} : lists_of(of);
        std::erase_if(lists, [&](const KeyList& list) {
            return std::ranges::find(wanted, list.of) == wanted.end();
        });
    }
    if (lists.empty())
        throw UsageError("OF", fmt::format("\"{}\" is unknown; {}", of, suggestion(of, names)));
    return lists;
}

}  // namespace stipple
