#include "python/sensor.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/config.h"
#include "python/bindings.h"
#include "python/errors.h"

namespace stipple::python {
namespace {

/// The sensor's numbers, by the names of docs/sensor_model.md.
void bind_numbers(py::class_<ChosenSensor>& sensor) {
    const auto add = [&](const char* name, auto SensorParams::*number, const char* text) {
        sensor.def_property_readonly(
            name, [number](const ChosenSensor& self) { return self.description.params.*number; },
            text);
    };
    add("name", &SensorParams::name, "Name, for messages.");
    add("photons_per_unit", &SensorParams::photons_per_unit,
        "Mean photons per site and slot at light 1.0.");
    add("full_scale_e", &SensorParams::full_scale_e, "Electrons of the highest DN.");
    add("full_well_e", &SensorParams::full_well_e, "Electrons that a pixel holds.");
    add("read_noise_e", &SensorParams::read_noise_e,
        "Standard deviation of a reading, in electrons.");
    add("shot_noise", &SensorParams::shot_noise, "Whether photons come at random (Poisson).");
    add("bit_depth", &SensorParams::bit_depth, "Bits of a DN.");
    add("slot_us", &SensorParams::slot_us, "Microseconds of a time slot, one frame of the video.");
    add("charge_stores", &SensorParams::charge_stores,
        "Exposures of a pixel that can be under way at once.");
}

/// A value of a setting as TOML writes it. \throws TypeError naming `key` if TOML has none such.
std::string setting_text(py::object value, const py::handle& key) {
    if (py::isinstance<py::str>(value)) return value.cast<std::string>();
    if (py::hasattr(value, "tolist")) value = value.attr("tolist")();
    if (py::isinstance<py::float_>(value)) return py::repr(value);  // JSON has no nan and inf
    try {
        return py::module_::import("json").attr("dumps")(value).cast<std::string>();
    } catch (py::error_already_set&) {
        throw py::type_error(fmt::format("setting {}: {} is no value of one",
                                         key.cast<std::string>(), std::string(py::repr(value))));
    }
}

std::string settings_text(const SensorChoice& choice) {
    std::string text;
    for (const std::string& setting : choice.settings) text += ", " + setting;
    return text;
}

}  // namespace

std::vector<std::string> settings_of(const py::dict& settings) {
    std::vector<std::string> texts;
    for (const auto& [key, value] : settings) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error(
                fmt::format("key {} of a setting is no text", std::string(py::repr(key))));
        texts.push_back(fmt::format("{}={}", key.cast<std::string>(),
                                    setting_text(py::reinterpret_borrow<py::object>(value), key)));
    }
    return texts;
}

ChosenSensor choose_sensor(const py::object& name, const py::dict& settings) {
    SensorChoice choice{.sensor = path_in(name, "sensor").string(),
                        .settings = settings_of(settings)};
    const auto read = [&] { return read_sensor_file(choice); };
    const std::filesystem::path path(choice.sensor);
    const bool is_path = path.has_parent_path() || path.has_extension();
    auto description = is_path ? reading(path, read) : read();
    return {std::move(choice), std::move(description)};
}

ChosenSensor sensor_of(const py::object& sensor) {
    if (py::isinstance<ChosenSensor>(sensor)) return sensor.cast<ChosenSensor>();
    return choose_sensor(sensor, {});
}

void bind_sensor(py::module_& module) {
    py::class_<ChosenSensor> sensor(module, "Sensor", R"(A camera chip: a file of config/sensors.

sensor: one of Sensor.names(), or the path of a .toml file of that form.
settings: keys of the file to change, {"read_noise_e": 5, "timing.addressing": "group"}.

Raises ValueError for a key or value that the file may not have, OSError for a missing file.)");
    sensor
        .def(py::init(&choose_sensor), py::arg("sensor") = "paper",
             py::arg("settings") = py::dict())
        .def_static(
            "names", [] { return config_names(ConfigKind::kSensors); },
            "The sensors of config/sensors.")
        .def_property_readonly(
            "has_timing",
            [](const ChosenSensor& self) { return self.description.timing.has_value(); },
            "Whether the file says how fast the chip reads (a section [timing]).")
        .def_property_readonly(
            "gain_e_per_dn",
            [](const ChosenSensor& self) { return self.description.params.gain_e_per_dn(); },
            "Electrons per DN.")
        .def("__repr__", [](const ChosenSensor& self) {
            return fmt::format("<stipple.Sensor {}{}>", self.choice.sensor,
                               settings_text(self.choice));
        });
    bind_numbers(sensor);
}

}  // namespace stipple::python
