#include "apps/emulate_switch.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/text.h"
#include "readout/emulator.h"
#include "readout/sensor_switch.h"

namespace stipple {
namespace {

constexpr char kOption[] = "--switch";

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
    try {
        change_sensor(std::string_view(text).substr(text.find(':') + 1), choice);
    } catch (const InputError& e) {
        throw UsageError(kOption, fmt::format("{}: {}", text, e.what()));
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
        setups_.push_back(set_up_switch(setup, first, filter));
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
