#pragma once

/// Sensors: photons to digital numbers, readout timing, schedule. Those of config/sensors have
/// names; settings are keys of their files (docs/physics.md, `stipple list keys`):
///
///     const stipple::SensorSetup sensor = stipple::set_up_sensor(
///         {.sensor = "lux1310", .schedule = "random", .settings = {"read_noise_e=5"}},
///         {.rows = 48, .cols = 64, .planes = 1});
///     std::cout << sensor.params.name << ": " << sensor.params.slot_us << " us a slot\n";
#include "readout/rig.h"
#include "readout/sensor_file.h"
