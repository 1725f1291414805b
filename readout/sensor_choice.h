#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "readout/timing/overrun_policy.h"

namespace stipple {

/// Names the files of a sensor and of its schedule, and the keys that differ from them. Names are
/// those of config/sensors and config/schedules.
struct SensorChoice {
    std::string sensor = "paper";                     ///< name or file
    std::string schedule = "random";                  ///< name, file, or compiled file (.mem, .hex)
    std::vector<std::string> settings = {};           ///< "key=value", laid over the sensor's file
    std::vector<std::string> schedule_settings = {};  ///< the same of the schedule
    std::uint64_t seed = 1;                           ///< of noise and schedule
    OverrunPolicy overrun = OverrunPolicy::kStretch;
};

}  // namespace stipple
