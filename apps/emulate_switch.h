#pragma once

#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "core/colour_filter.h"
#include "readout/sensor_file.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// `--switch SLOT:KEY=VALUE,...`, once for each switch. \throws UsageError.
void add_switches(Command& command, std::vector<std::string>& texts);

/// The switches of `emulate`, in which the sensor changes between two slots.
class SensorSwitches {
  public:
    /// `setup` is that of `first`, for footage with the mosaic `filter`; each text changes the
    /// sensor of the one before. \throws InputError as set_up_sensor and check_switch.
    SensorSwitches(const std::vector<std::string>& texts, SensorChoice first,
                   const SensorSetup& setup, ColourFilter filter);

    /// Before a slot is exposed: switches the sensor if it is the slot of the next one. \throws
    /// InputError, DeviceError as StreamRecorder::switch_to.
    void apply(StreamRecorder& recorder);
    /// Warning that the footage ended before a switch; else empty.
    [[nodiscard]] std::string unused_text(const std::string& footage) const;

  private:
    std::vector<std::int64_t> slots_;
    std::deque<SensorSetup> setups_;
    std::size_t next_ = 0;
};

}  // namespace stipple
