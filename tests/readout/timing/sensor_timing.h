#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "readout/timing/readout_timing.h"
#include "sensor_model/sensor_config.h"
#include "tests/support/source_tree.h"

namespace stipple {

/// The timing of a sensor of config/sensors, changed by `overrides` ("timing.channels=8").
inline ReadoutTiming sensor_timing(const std::string& name,
                                   const std::vector<std::string>& overrides = {}) {
    const auto folder = project_path("config/sensors");
    Config config(folder / (name + ".toml"), overrides);
    const SensorParams params = read_sensor(config);
    const auto timing = read_timing(config, params.bit_depth);
    config.reject_unknown_keys();
    return timing.value();
}

}  // namespace stipple
