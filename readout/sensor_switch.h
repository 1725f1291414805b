#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "core/colour_filter.h"
#include "readout/sensor_file.h"

namespace stipple {

/// Lays changes over a sensor: schedule=NAME, seed=N, schedule.KEY=VALUE and sensor.KEY=VALUE, with
/// commas between them. Another schedule forgets the keys of the one before. \throws InputError
/// naming the change that is none of them.
void change_sensor(std::string_view changes, SensorChoice& choice);

/// `choice`, to which the sensor `from` switches: with its light and the seed of its noise.
/// \throws InputError as set_up_sensor.
[[nodiscard]] SensorSetup set_up_switch(const SensorSetup& from, const SensorChoice& choice,
                                        ColourFilter mosaic);

/// Changes of a sensor that is being emulated by another thread.
class SensorControl {
  public:
    /// `choice` is that of `setup`, for footage with this mosaic. `setup` must outlive this.
    SensorControl(SensorChoice choice, const SensorSetup& setup, ColourFilter mosaic);

    /// Switches the sensor between two slots, and returns the first one after it. \throws
    /// InputError as change_sensor, set_up_switch and the switch; DeviceError if the emulation has
    /// ended.
    std::int64_t change(std::string_view changes);
    /// Of the last change.
    [[nodiscard]] SensorChoice choice() const;

    /// Between two slots, by the thread that emulates: calls `switch_to`, which returns the next
    /// slot, if a change waits. What it throws is thrown by `change`.
    void apply(const std::function<std::int64_t(const SensorSetup&)>& switch_to);
    /// The emulation has ended.
    void end();

  private:
    struct Waiting {
        SensorSetup setup;
        std::promise<std::int64_t> slot;
    };

    std::mutex changing_;  ///< one at a time
    mutable std::mutex mutex_;
    SensorChoice choice_;
    const SensorSetup& setup_;
    ColourFilter mosaic_;
    std::optional<Waiting> waiting_;
    std::atomic<bool> is_waiting_ = false;
    bool ended_ = false;
};

}  // namespace stipple
