#pragma once

#include <vector>

#include "apps/command_line.h"
#include "apps/settings_argument.h"
#include "readout/sensor_file.h"

namespace stipple {

/// `--sensor`, `--schedule`, `--seed` and `--overrun`.
void add_sensor_arguments(Command& command, SensorChoice& sensor);

/// What `--set sensor.KEY=VALUE` and `--set schedule.KEY=VALUE` change.
[[nodiscard]] std::vector<SettingsSection> sensor_sections(SensorChoice& sensor);

}  // namespace stipple
