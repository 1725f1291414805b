#pragma once

#include "core/emva1288_figures.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// The figures that an evaluation of this sensor would find without noise of its own. Defects
/// count: dead pixels lower the quantum efficiency and raise the PRNU, hot ones raise the DSNU.
[[nodiscard]] emva1288::CameraFigures configured_figures(const SensorParams& params);

}  // namespace stipple
