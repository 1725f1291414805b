#pragma once

#include "core/config.h"
#include "core/emva1288_figures.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// The sensor that a file of config/sensors describes; an absent key keeps its default. Other
/// keys are left for the caller's `reject_unknown_keys`.
/// \throws InputError naming file, line and key for a wrong type, a value outside its range, or a
/// key of the physical mode in paper mode; as `validate` for values that do not go together.
[[nodiscard]] SensorParams read_sensor(Config& config);

/// The figures that an evaluation of this sensor would find without noise of its own. Defects
/// count: dead pixels lower the quantum efficiency and raise the PRNU, hot ones raise the DSNU.
[[nodiscard]] emva1288::CameraFigures configured_figures(const SensorParams& params);

}  // namespace stipple
