#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "io/disk_sync.h"
#include "io/output_names.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/emulation.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/footage.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "python/stream.h"
#include "readout/emulation_figures.h"
#include "readout/emulator.h"
#include "readout/provenance.h"
#include "readout/timing/readout_figures.h"

namespace stipple::python {

py::dict figures_of(const StreamRecorder& recorder) {
    py::dict figures = dict_of([&](const auto& add) { visit_emulation_figures(recorder, add); });
    if (const ReadoutCost* cost = recorder.emulator().readout_cost())
        figures["readout"] = dict_of([&](const auto& add) {
            visit_cost_figures(*cost, recorder.emulator().light_throughput(), add);
        });
    return figures;
}

OverrunPolicy overrun_policy(const std::string& name) {
    return value_in(kOverrunPolicies, name, "overrun");
}

namespace {

/// A sensor with its schedule, and what it is from some slots on.
struct Setup {
    SensorSetup sensor;
    std::vector<std::pair<std::int64_t, SensorSetup>> switches = {};  ///< by slot

    /// \throws InputError as check_switch, or if there is none before `slot`.
    void switch_to(const Setup& next, std::int64_t slot) {
        if (slot < 1)
            throw InputError("switches", fmt::format("slot {} is not 1 or a later one", slot));
        check_switch(sensor, next.sensor, slot);
        switches.emplace_back(slot, next.sensor).second.seed = sensor.seed;  // of the noise
    }
};

/// For some footage.
Setup set_up_for(const Footage& footage, const py::object& sensor, const py::object& schedule,
                 const py::object& seed, const std::string& overrun) {
    ChosenSensor chosen = sensor_of(sensor);
    chosen.choice.seed = whole_in(seed, "seed");
    chosen.choice.overrun = overrun_policy(overrun);
    return {set_up(chosen, schedule, footage.shape(), footage.filter())};
}

/// Makes the stream file, and returns its figures.
py::dict write_stream(Footage& footage, const Setup& what, const py::object& tell,
                      const std::filesystem::path& file, bool force) {
    const SensorSetup& setup = what.sensor;
    SensorSetup named = setup;
    if (!what.switches.empty()) named.origin.reset();  // no command makes this stream again
    const std::string provenance = provenance_of(named, footage.origin());
    const auto recorder = creating(file, [&] {
        return std::make_unique<StreamRecorder>(
            file, setup,
            StreamRecorderOptions{
                .force = force, .may_switch = !what.switches.empty(), .provenance = provenance});
    });
    ResampledFootage slots = footage.resampled(setup.params.slot_us);
    CallProgress progress(tell, slots.slots());
    double done = 0;
    auto next = what.switches.begin();
    {
        const py::gil_scoped_release released;
        for (auto frame = slots.next(); !frame.empty(); frame = slots.next()) {
            if (next != what.switches.end() && next->first == static_cast<std::int64_t>(done))
                recorder->switch_to(next++->second);
            recorder->expose(frame);
            if (!progress.reach(++done)) break;
        }
    }
    if (done == 0) throw InputError(footage.name(), "is shorter than a slot of the sensor");
    progress.finish();
    {
        const py::gil_scoped_release released;
        recorder->finish();
    }
    return figures_of(*recorder);
}

std::unique_ptr<StreamFile> emulate(Footage& footage, const Setup& what,
                                    const std::optional<std::filesystem::path>& output, bool force,
                                    const py::object& tell) {
    if (output) check_name(*output, kStreamName);
    const SensorSetup& setup = what.sensor;
    warn(mosaic_warning(setup, footage.filter()));
    footage.warn_of(setup.params);
    std::unique_ptr<StreamFile> stream;
    if (output) {
        const py::dict figures = write_stream(footage, what, tell, *output, force);
        stream = std::make_unique<StreamFile>(*output, figures);
    } else {
        const NoSync no_sync;
        auto file = std::make_unique<TemporaryFile>();
        const py::dict figures = write_stream(footage, what, tell, file->path(), false);
        file->unname();
        stream = std::make_unique<StreamFile>(std::move(file), figures);
    }
    footage.pass_warnings_on(&setup.params);
    return stream;
}

}  // namespace

void bind_emulate(py::module_& module) {
    py::class_<Setup>(module, "Setup")
        .def(py::init(&set_up_for))
        .def("switch_to", &Setup::switch_to);
    module.def("emulate", &emulate);
}

}  // namespace stipple::python
