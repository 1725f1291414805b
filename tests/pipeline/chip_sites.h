#pragma once

#include <vector>

#include "calibration/chip_estimate.h"
#include "core/geometry.h"
#include "readout/flat_field.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// The calibration of an emulated chip, from the series of `stipple calibrate --sensor`.
[[nodiscard]] ChipEstimate calibrated_chip(const SensorParams& sensor, FrameShape shape,
                                           const CalibrationImages& images);

/// The same sensor with equal, linear pixels, without defects.
[[nodiscard]] SensorParams without_fixed_pattern(SensorParams sensor);

}  // namespace stipple
