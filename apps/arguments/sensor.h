#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "apps/arguments/settings.h"
#include "readout/sensor_file.h"
#include "readout/timing/overrun_policy.h"
#include "readout/timing/waveform_file.h"

namespace stipple {

/// `--sensor`.
CommandOption add_sensor(Command& command, std::string& sensor);

/// `--schedule`.
CommandOption add_schedule(Command& command, std::string& schedule);

/// `--sensor`, `--schedule`, `--seed` and `--overrun`.
void add_sensor_arguments(Command& command, SensorChoice& sensor);

/// `--overrun stretch|drop`.
void add_overrun(Command& command, OverrunPolicy& policy);

/// The sections of `--set sensor.KEY=VALUE` and `--set schedule.KEY=VALUE`.
[[nodiscard]] std::vector<SettingsSection> sensor_sections(SensorChoice& sensor);

/// `--vcd` and `--vcd-slots`.
struct WaveformOptions {
    std::string file;  ///< empty: none
    int slots = 16;
};
void add_waveform_arguments(Command& command, WaveformOptions& options);

/// The waveform file of the options; none if its name is empty. \throws InputError as WaveformFile,
/// or if the sensor has no timing.
[[nodiscard]] std::optional<WaveformFile> waveform_file(const WaveformOptions& options, bool force,
                                                        bool has_timing);

}  // namespace stipple
