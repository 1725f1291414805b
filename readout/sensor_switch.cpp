#include "readout/sensor_switch.h"

#include <utility>
#include <vector>

#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

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

/// What follows `key`, if the text begins with it.
std::optional<std::string> after(const std::string& text, std::string_view key) {
    return text.starts_with(key) ? std::optional(text.substr(key.size())) : std::nullopt;
}

}  // namespace

void change_sensor(std::string_view changes, SensorChoice& choice) {
    for (const std::string& part : between_commas(changes)) {
        const auto seed = parsed_number<std::uint64_t>(after(part, "seed=").value_or(""));
        if (const auto name = after(part, "schedule=")) {
            choice.schedule = *name;
            choice.schedule_settings.clear();
        } else if (const auto setting = after(part, "sensor.")) {
            choice.settings.push_back(*setting);
        } else if (const auto own = after(part, "schedule.")) {
            choice.schedule_settings.push_back(*own);
        } else if (seed) {
            choice.seed = *seed;
        } else {
            throw InputError(part,
                             "is none of schedule=NAME, seed=N, schedule.KEY=VALUE, "
                             "sensor.KEY=VALUE");
        }
    }
}

SensorSetup set_up_switch(const SensorSetup& from, const SensorChoice& choice,
                          ColourFilter mosaic) {
    SensorSetup setup = set_up_sensor(choice, from.footage, mosaic);
    setup.seed = from.seed;
    return setup;
}

SensorControl::SensorControl(SensorChoice choice, const SensorSetup& setup, ColourFilter mosaic)
    : choice_(std::move(choice)), setup_(setup), mosaic_(mosaic) {}

SensorChoice SensorControl::choice() const {
    const std::lock_guard lock(mutex_);
    return choice_;
}

std::int64_t SensorControl::change(std::string_view changes) {
    const std::lock_guard one_at_a_time(changing_);
    SensorChoice next = choice();
    change_sensor(changes, next);
    Waiting waiting{set_up_switch(setup_, next, mosaic_), {}};
    std::future<std::int64_t> slot = waiting.slot.get_future();
    {
        const std::lock_guard lock(mutex_);
        if (ended_) throw DeviceError("sensor", "is emulated no more");
        waiting_ = std::move(waiting);
        is_waiting_ = true;
    }
    const std::int64_t first = slot.get();
    const std::lock_guard lock(mutex_);
    choice_ = std::move(next);
    return first;
}

void SensorControl::apply(const std::function<std::int64_t(const SensorSetup&)>& switch_to) {
    if (!is_waiting_) return;
    std::optional<Waiting> waiting;
    {
        const std::lock_guard lock(mutex_);
        waiting = std::exchange(waiting_, std::nullopt);
        is_waiting_ = false;
    }
    if (!waiting) return;
    try {
        waiting->slot.set_value(switch_to(waiting->setup));
    } catch (...) {
        waiting->slot.set_exception(std::current_exception());
    }
}

void SensorControl::end() {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    if (waiting_)
        waiting_->slot.set_exception(
            std::make_exception_ptr(DeviceError("sensor", "is emulated no more")));
    waiting_.reset();
}

}  // namespace stipple
