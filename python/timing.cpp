#include <fmt/format.h>
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <utility>

#include "core/error.h"
#include "core/light.h"
#include "python/bindings.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "readout/program/sequencer_program.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"

namespace stipple::python {
namespace {

using namespace pybind11::literals;
using Size = std::optional<std::pair<std::uint64_t, std::uint64_t>>;  ///< rows, columns

const ReadoutTiming& timing_of(const ChosenSensor& sensor) {
    if (!sensor.description.timing)
        throw InputError(fmt::format("sensor \"{}\"", sensor.choice.sensor), no_timing_text());
    return *sensor.description.timing;
}

/// How busy a chip is, and what a slot of its steady period costs.
py::dict load_of(const ReadoutRate& rate, const ReadoutCost& cost) {
    const ReadoutCounts& counts = rate.period;
    const auto slots = static_cast<double>(cost.schedule().period_slots());
    const double clocks = rate.mean_slot_clocks * slots;
    const int rows = cost.shape().rows + cost.timing().dark_rows;
    const auto pixels = static_cast<double>(cost.shape().pixels());
    return py::dict(
        "row_utilisation"_a = static_cast<double>(counts.rows) / (slots * rows),
        "adc_utilisation"_a = static_cast<double>(counts.convert_clocks) / clocks,
        "link_utilisation"_a = static_cast<double>(counts.link_clocks) / clocks,
        "samples_per_slot"_a = static_cast<double>(counts.samples) / slots,
        "transferred_per_slot"_a = static_cast<double>(counts.transferred) / slots,
        "link_bits_per_second"_a = static_cast<double>(counts.bits) / slots * rate.coded_hz,
        "full_energy_uj"_a = rate.full_energy_pj * 1e-6,
        "slot_energy_uj"_a = counts.energy_pj / slots * 1e-6,
        "full_sample_energy_pj"_a = rate.full_energy_pj / static_cast<double>(cost.shape().sites()),
        "slot_sample_energy_pj"_a = counts.energy_pj / static_cast<double>(counts.samples),
        "schedule_memory_bits"_a = schedule_memory_bits(cost.schedule()),
        "code_load_clocks"_a = cost.timing().code_load_clocks,
        "code_load_bits_per_second"_a = pixels * rate.coded_hz);
}

py::dict rate_dict(const ReadoutRate& rate, const ReadoutCost& cost) {
    const ReadoutTiming& timing = cost.timing();
    const auto seconds = [&](std::int64_t clocks) {
        return static_cast<double>(clocks) / static_cast<double>(timing.clock_hz);
    };
    const std::string& hypothetical = timing.hypothetical;
    py::dict dict(
        "hypothetical"_a = hypothetical.empty() ? std::nullopt : std::optional(hypothetical),
        "rows"_a = cost.shape().rows, "cols"_a = cost.shape().cols,
        "full_readout_hz"_a = rate.full_hz, "coded_readout_hz"_a = rate.coded_hz,
        "speedup"_a = rate.speedup, "limited_by"_a = std::string(name_of(rate.slowest.limit)),
        "frame_clocks"_a = rate.full.total, "frame_time_s"_a = seconds(rate.full.total),
        "row_clocks"_a = rate.full.row, "full_settle_clocks"_a = rate.full.settle,
        "slowest_settle_clocks"_a = rate.slowest.settle_clocks,
        "balanced_speedup"_a = rate.balanced_speedup, "balanced_row_clocks"_a = rate.even.row,
        "slowest_slot_clocks"_a = rate.slowest.clocks,
        "slowest_slot_time_s"_a = seconds(rate.slowest.clocks),
        "slowest_phase"_a = rate.slowest_phase, "mean_slot_clocks"_a = rate.mean_slot_clocks,
        "mean_coded_readout_hz"_a = rate.mean_coded_hz, "slot_clocks"_a = cost.budget().clocks,
        "fits_slot"_a = rate.slowest.clocks <= cost.budget().clocks);
    dict.attr("update")(load_of(rate, cost));
    return dict;
}

py::dict timing(const py::object& chosen_sensor, const py::object& schedule, const Size& size,
                std::uint64_t seed) {
    const ChosenSensor sensor = sensor_of(chosen_sensor);
    const ReadoutTiming& clocks = timing_of(sensor);
    SensorChoice choice = sensor.choice;
    choice.seed = seed;
    FrameShape shape = size ? checked_shape(size->first, size->second, 1, "size")
                            : FrameShape{.rows = clocks.rows, .cols = clocks.cols};
    if (!size && py::isinstance<ChosenSchedule>(schedule))
        shape = schedule.cast<const ChosenSchedule&>().shape;
    const SensorSetup setup = set_up(choice, schedule, shape, ColourFilter::kNone);
    const SlotBudget budget{slot_clocks(clocks, setup.params.slot_us), OverrunPolicy::kStretch};
    ReadoutCost cost(clocks, setup.schedule.schedule, shape, budget);
    py::dict figures("sensor"_a = setup.params.name, "schedule"_a = setup.schedule.name);
    figures.attr("update")(rate_dict(rate_of(clocks, setup.schedule.schedule, shape), cost));
    return figures;
}

}  // namespace

void bind_timing(py::module_& module) {
    module.def("timing", &timing);
}

}  // namespace stipple::python
