#include "python/sensor.h"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "core/config.h"
#include "core/error.h"
#include "python/bindings.h"
#include "python/errors.h"

namespace stipple::python {
namespace fs = std::filesystem;
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

/// A value of a setting as TOML writes it, in a list with quotes. \throws TypeError naming `key` if
/// TOML has none such, InputError if it is too large.
std::string setting_text(py::object value, const std::string& key, bool in_list = false) {
    if (py::hasattr(value, "tolist")) value = value.attr("tolist")();
    if (py::isinstance<py::str>(value) && !in_list) return value.cast<std::string>();
    if (py::isinstance<py::float_>(value)) return py::repr(value);  // JSON has no nan and inf
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
        std::string items;
        for (const auto& item : value)
            items += setting_text(py::reinterpret_borrow<py::object>(item), key, true) + ", ";
        return "[" + items + "]";
    }
    if (!py::isinstance<py::str>(value) && !py::isinstance<py::int_>(value))  // bool is an int
        throw py::type_error(
            fmt::format("setting {}: {} is not a text, a number, True, False or "
                        "a list of them",
                        key, short_text(value)));
    if (py::isinstance<py::int_>(value) && PyLong_AsLongLong(value.ptr()) == -1 &&
        PyErr_Occurred()) {
        PyErr_Clear();
        throw InputError("setting " + key,
                         fmt::format("{} is outside -2^63..2^63 - 1", short_text(value)));
    }
    return py::module_::import("json").attr("dumps")(value).cast<std::string>();
}

std::string settings_text(const SensorChoice& choice) {
    std::string text;
    for (const std::string& setting : choice.settings) text += ", " + setting;
    return text;
}

}  // namespace

bool is_path(const fs::path& name) {
    return name.has_parent_path() || name.has_extension();
}

std::vector<std::string> settings_of(const py::dict& settings) {
    std::vector<std::string> texts;
    for (const auto& [key, value] : settings) {
        if (!py::isinstance<py::str>(key))
            throw py::type_error(
                fmt::format("key {} of a setting is not a text", std::string(py::repr(key))));
        texts.push_back(fmt::format(
            "{}={}", key.cast<std::string>(),
            setting_text(py::reinterpret_borrow<py::object>(value), key.cast<std::string>())));
    }
    return texts;
}

py::dict settings_dict(const std::vector<std::string>& texts) {
    py::dict settings;
    for (const std::string& text : texts) {
        const auto equals = text.find('=');
        settings[py::str(text.substr(0, equals))] = text.substr(equals + 1);
    }
    return settings;
}

ChosenSensor choose_sensor(const py::object& name, const py::dict& settings) {
    SensorChoice choice{.sensor = path_in(name, "sensor").string(),
                        .settings = settings_of(settings)};
    const auto read = [&] { return read_sensor_file(choice); };
    auto description = is_path(choice.sensor) ? reading(choice.sensor, read) : read();
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
        .def("__reduce__",
             [](const ChosenSensor& self) {
                 const std::string& name = self.choice.sensor;
                 return py::make_tuple(
                     py::type::of<ChosenSensor>(),
                     py::make_tuple(is_path(name) ? fs::absolute(name) : fs::path(name),
                                    settings_dict(self.choice.settings)));
             })
        .def("__repr__", [](const ChosenSensor& self) {
            return fmt::format("<stipple.Sensor {}{}>", self.choice.sensor,
                               settings_text(self.choice));
        });
    bind_numbers(sensor);
}

}  // namespace stipple::python
