#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/light.h"
#include "python/bindings.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "readout/timing/readout_figures.h"

namespace stipple::python {
namespace {

const ReadoutTiming& timing_of(const ChosenSensor& sensor) {
    if (!sensor.description.timing)
        throw InputError(fmt::format("sensor \"{}\"", sensor.choice.sensor), no_timing_text());
    return *sensor.description.timing;
}

/// `size` is None or (rows, columns).
py::dict timing(const py::object& chosen_sensor, const py::object& schedule, const py::object& size,
                const py::object& seed) {
    ChosenSensor sensor = sensor_of(chosen_sensor);
    const ReadoutTiming& clocks = timing_of(sensor);
    sensor.choice.seed = whole_in(seed, "seed");
    FrameShape shape{.rows = clocks.rows, .cols = clocks.cols};
    if (!size.is_none()) {
        const auto [rows, cols] = size_in(size, "size");
        shape = checked_shape(rows, cols, 1, "size");
    } else if (py::isinstance<ChosenSchedule>(schedule)) {
        shape = schedule.cast<const ChosenSchedule&>().shape;
    }
    const SensorSetup setup = set_up(sensor, schedule, shape, ColourFilter::kNone);
    const SlotBudget budget{slot_clocks(clocks, setup.params.slot_us), OverrunPolicy::kStretch};
    ReadoutCost cost(clocks, setup.schedule.schedule, shape, budget);
    const ReadoutRate rate = rate_of(clocks, setup.schedule.schedule, shape, budget.clocks);
    return dict_of([&](const auto& add) {
        add("sensor", setup.params.name);
        add("schedule", setup.schedule.name);
        visit_rate_figures(rate, cost, add);
        visit_period_figures(rate, cost, add);
    });
}

}  // namespace

void bind_timing(py::module_& module) {
    module.def("timing", &timing);
}

}  // namespace stipple::python
