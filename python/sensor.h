#pragma once

#include <pybind11/pytypes.h>

#include <filesystem>
#include <string>
#include <vector>

#include "readout/sensor_file.h"

namespace stipple::python {

/// A sensor that Python has chosen.
struct ChosenSensor {
    SensorChoice choice;  ///< `sensor` and `settings`
    SensorDescription description;
};

/// Whether the name of a sensor or schedule is that of a file.
[[nodiscard]] bool is_path(const std::filesystem::path& name);

/// "key=value" of a dict: texts as on the command line, other values as TOML writes them.
[[nodiscard]] std::vector<std::string> settings_of(const pybind11::dict& settings);

/// The dict of which `settings_of` makes these texts.
[[nodiscard]] pybind11::dict settings_dict(const std::vector<std::string>& texts);

/// \throws InputError as read_sensor_file, FileError for a path that leads nowhere.
[[nodiscard]] ChosenSensor choose_sensor(const pybind11::object& name,
                                         const pybind11::dict& settings);

/// A ChosenSensor of Python, or one of this name or path.
[[nodiscard]] ChosenSensor sensor_of(const pybind11::object& sensor);

}  // namespace stipple::python
