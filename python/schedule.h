#pragma once

#include <pybind11/numpy.h>

#include <string>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "python/sensor.h"
#include "readout/sensor_file.h"

namespace stipple::python {

/// A schedule that Python has chosen, made for an array.
struct ChosenSchedule {
    SensorChoice choice;  ///< `schedule`, `schedule_settings` and `seed`
    FrameShape shape;
    NamedSchedule made;
    pybind11::object sensor;  ///< whose columns it suits, a ChosenSensor of Python; else None
};

/// All exposures of the tile: an array with the fields row, col, first_slot and open_slots.
[[nodiscard]] pybind11::array exposures_of(const ExposureSchedule& schedule);

/// The weight of each slot and pixel: (slot of the period, row, col of the tile), 0 in closed slots
/// and 1 in open ones of a schedule without weights. \throws InputError if memory does not suffice.
[[nodiscard]] pybind11::array weights_of(const ExposureSchedule& schedule);

/// The sensor with the seed for which a ChosenSchedule of Python was made; unchanged with a name.
[[nodiscard]] ChosenSensor with_seed_of(const pybind11::object& schedule, ChosenSensor sensor);

/// The sensor with the schedule, a ChosenSchedule of Python or a name or path, for this footage.
/// \throws InputError as set_up_sensor, or if the schedule was made for something else.
[[nodiscard]] SensorSetup set_up(const ChosenSensor& sensor, const pybind11::object& schedule,
                                 FrameShape footage, ColourFilter mosaic);

}  // namespace stipple::python
