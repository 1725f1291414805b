#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "io/output_names.h"
#include "python/bindings.h"
#include "python/emulation.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "readout/chip/register_chip.h"
#include "readout/chip/register_map.h"

namespace stipple::python {
namespace {

/// What a chip films, for each capture from its first frame on.
struct ChipLight {
    py::object video;
    Reading reading;
};

/// The sizes that differ from those of the schedule.
struct ChipMemory {
    std::optional<std::pair<int, int>> tile;  ///< rows, columns
    std::optional<int> depth;
    std::optional<int> pixel_bits;
};

/// Deletes what holds an object of Python, from any thread.
template <typename Held>
std::shared_ptr<Held> shared_with_python(Held* held) {
    return std::shared_ptr<Held>(held, [](Held* last) {
        const py::gil_scoped_acquire acquired;
        delete last;
    });
}

struct OpenedLight {
    OpenedLight(const ChipLight& light, double slot_us)
        : footage(light.video, light.reading), slots(footage.resampled(slot_us)) {}

    Footage footage;
    ResampledFootage slots;
};

OpenLight light_of(ChipLight light, double slot_us) {
    const auto held = shared_with_python(new ChipLight(std::move(light)));
    return [held, slot_us]() -> SlotLight {
        const py::gil_scoped_acquire acquired;
        const auto opened = shared_with_python(new OpenedLight(*held, slot_us));
        return [opened] { return opened->slots.next(); };
    };
}

/// A chip, its sensor and schedule.
class PythonChip {
  public:
    PythonChip(ChipLight light, const std::filesystem::path& output, bool force,
               const SensorSetup& setup, const ChipMemory& memory, const FootageOrigin& origin)
        : chip_(setup, geometry_for(setup, memory),
                {.output = output,
                 .force = force,
                 .footage = origin,
                 .open_light = light_of(std::move(light), setup.params.slot_us)}) {}

    [[nodiscard]] RegisterChip& chip() { return chip_; }

    std::uint32_t read(const py::object& place) {
        const std::uint32_t address = address_of(place);
        std::optional<std::uint32_t> value;
        {
            const py::gil_scoped_release released;
            value = chip_.read(address);
        }
        if (!value) throw InputError("chip", chip_.take_problem());
        warn(chip_.take_problem(), 1);
        return *value;
    }
    void write(const py::object& place, const py::object& number) {
        const std::uint32_t address = address_of(place);
        const std::uint64_t value = whole_in(number, "value");
        if (value >> 32U != 0) throw InputError("value", "is more than 32 bits");
        bool is_written = false;
        {
            const py::gil_scoped_release released;
            is_written = chip_.write(address, static_cast<std::uint32_t>(value));
        }
        if (!is_written) throw InputError("chip", chip_.take_problem());
        warn(chip_.take_problem(), 1);
    }
    void wait(const py::object& clocks) {
        constexpr std::uint64_t kStep = 4096;
        for (std::uint64_t left = whole_in(clocks, "clocks"); left > 0;) {
            const std::uint64_t step = std::min(left, kStep);
            {
                const py::gil_scoped_release released;
                chip_.wait(static_cast<std::int64_t>(step));
            }
            left -= step;
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        }
        warn(chip_.take_problem(), 1);
    }
    void finish() {
        {
            const py::gil_scoped_release released;
            chip_.finish();
        }
        warn(chip_.take_problem(), 1);
    }

  private:
    static ChipGeometry geometry_for(const SensorSetup& setup, const ChipMemory& memory) {
        ChipGeometry geometry = geometry_of(setup);
        if (memory.tile) std::tie(geometry.tile_rows, geometry.tile_cols) = *memory.tile;
        geometry.depth = memory.depth.value_or(geometry.depth);
        geometry.pixel_bits = memory.pixel_bits.value_or(geometry.pixel_bits);
        return geometry;
    }
    static std::uint32_t address_of(const py::object& place) {
        if (py::isinstance<py::str>(place)) return register_address(place.cast<std::string>());
        const std::uint64_t address = whole_in(place, "register");
        if (address >> 32U != 0) throw InputError("register", "is more than 32 bits");
        return static_cast<std::uint32_t>(address);
    }

    RegisterChip chip_;
};

std::unique_ptr<PythonChip> make_chip(const ChipLight& light, const py::object& sensor,
                                      const py::tuple& schedule, const ChipMemory& memory,
                                      const py::tuple& output) {
    const auto file = path_in(output[0], "output");
    check_name(file, kStreamName);
    ChosenSensor chosen = sensor_of(sensor);
    chosen.choice.seed = whole_in(schedule[1], "seed");
    chosen.choice.overrun = overrun_policy(schedule[2].cast<std::string>());
    const Footage footage(light.video, light.reading);
    SensorSetup setup = set_up(chosen, schedule[0], footage.shape(), footage.filter());
    footage.warn_of(setup.params);
    return std::make_unique<PythonChip>(light, file, output[1].cast<bool>(), std::move(setup),
                                        memory, footage.origin());
}

}  // namespace

void bind_chip(py::module_& module) {
    py::class_<ChipLight>(module, "ChipLight").def(py::init<py::object, Reading>());
    py::class_<ChipMemory>(module, "ChipMemory")
        .def(
            py::init<std::optional<std::pair<int, int>>, std::optional<int>, std::optional<int>>());
    py::class_<PythonChip>(module, "RegisterChip")
        .def(py::init(&make_chip))
        .def("preset", [](PythonChip& it) { it.chip().preset(); })
        .def("read", &PythonChip::read)
        .def("write", &PythonChip::write)
        .def("wait", &PythonChip::wait)
        .def("finish", &PythonChip::finish)
        .def_property_readonly("clocks", [](PythonChip& it) { return it.chip().clocks(); })
        .def_property_readonly("outputs", [](PythonChip& it) {
            std::vector<std::string> names;
            for (const auto& file : it.chip().outputs()) names.push_back(file.string());
            return names;
        });
}

}  // namespace stipple::python
