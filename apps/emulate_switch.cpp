#include "apps/emulate_switch.h"

#include <fmt/format.h>

#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "readout/emulator.h"

namespace stipple {
namespace {

constexpr char kOption[] = "--switch";

/// The parts of a text between commas, but for those in brackets.
std::vector<std::string> between_commas(std::string_view text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (const char c : text) {
        if (c == '[') ++depth;
        if (c == ']') --depth;
        if (c == ',' && depth == 0)
            parts.emplace_back();
        else
            parts.back() += c;
    }
    return parts;
}

/// The slot of a switch. \throws UsageError.
std::int64_t slot_of(const std::string& text) {
    const std::size_t colon = text.find(':');
    const auto slot = parsed_number<std::int64_t>(text.substr(0, colon));
    if (!slot || *slot < 1 || colon == std::string::npos || colon + 1 == text.size())
        throw UsageError(kOption, text +
                                      ": is a slot from 1 on and what changes there, such as "
                                      "100:schedule=tiled");
    return *slot;
}

/// Lays what a switch changes over the sensor before it. \throws UsageError.
void change(const std::string& text, SensorChoice& choice) {
    const auto after = [](const std::string& part, std::string_view key) {
        return part.starts_with(key) ? std::optional(part.substr(key.size())) : std::nullopt;
    };
    for (const std::string& part : between_commas(text.substr(text.find(':') + 1))) {
        const auto seed = after(part, "seed=");
        if (const auto name = after(part, "schedule=")) {
            choice.schedule = *name;
            choice.schedule_settings.clear();
        } else if (const auto setting = after(part, "sensor.")) {
            choice.settings.push_back(*setting);
        } else if (const auto own = after(part, "schedule.")) {
            choice.schedule_settings.push_back(*own);
        } else if (const auto number = parsed_number<std::uint64_t>(seed.value_or("")); number) {
            choice.seed = *number;
        } else {
            throw UsageError(kOption, fmt::format("{}: {} is none of schedule=NAME, seed=N, "
                                                  "schedule.KEY=VALUE, sensor.KEY=VALUE",
                                                  text, part));
        }
    }
}

}  // namespace

void add_switches(Command& command, std::vector<std::string>& texts) {
    command
        .add_list(
            kOption,
            [&texts](const std::string& text) {
                const std::int64_t slot = slot_of(text);
                if (!texts.empty() && slot <= slot_of(texts.back()))
                    throw UsageError(kOption, text + ": comes before the switch that precedes it");
                SensorChoice unused;
                change(text, unused);
                texts.push_back(text);
            },
            "change the schedule (schedule=NAME), its keys (schedule.KEY=VALUE), its seed "
            "(seed=N) or values of the readout (sensor.KEY=VALUE) before a slot, without a reset; "
            "may be repeated (docs/stream_format.md)")
        .type_name("SLOT:KEY=VALUE,...");
}

SensorSwitches::SensorSwitches(const std::vector<std::string>& texts, SensorChoice first,
                               const SensorSetup& setup, ColourFilter filter) {
    for (const std::string& text : texts) {
        change(text, first);
        slots_.push_back(slot_of(text));
        setups_.push_back(set_up_sensor(first, setup.footage, filter));
        setups_.back().seed = setup.seed;  // of the noise
        check_switch(setup, setups_.back(), slots_.back());
    }
}

void SensorSwitches::apply(StreamRecorder& recorder) {
    if (next_ < slots_.size() && recorder.emulator().stats().slots == slots_[next_])
        recorder.switch_to(setups_[next_++]);
}

std::string SensorSwitches::unused_text(const std::string& footage) const {
    if (next_ == slots_.size()) return {};
    return fmt::format("{}: ends before slot {}, so there was no switch", footage, slots_[next_]);
}

}  // namespace stipple
