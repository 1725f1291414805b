#pragma once

#include "apps/command_line.h"
#include "readout/sensor_file.h"

namespace stipple {

/// `--sensor`, `--schedule`, `--seed`, `--overrun`, and the settings of both, which are `--set`
/// but where that is the camera's.
void add_sensor_arguments(Command& command, SensorChoice& sensor,
                          const char* settings_option = "--set");

}  // namespace stipple
