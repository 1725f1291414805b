#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/emulation.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/footage.h"
#include "python/sensor.h"
#include "readout/emulator.h"
#include "session/rig_emulation.h"
#include "session/rig_folder.h"

namespace stipple::python {
namespace {

py::dict rig_figures(const RigEmulation& rig) {
    py::list sensors;
    for (const RigRecorder& run : rig.recorders()) {
        py::dict figures;
        figures["name"] = run.sensor().name;
        figures["share"] = run.sensor().share;
        figures.attr("update")(figures_of(run.recorder()));
        sensors.append(figures);
    }
    py::dict figures;
    figures["sensors"] = sensors;
    const RigTotals totals = rig.totals();
    figures.attr("update")(dict_of([&](const auto& add) { visit_rig_figures(totals, add); }));
    return figures;
}

/// Makes the folder of a rig, and returns its figures.
py::dict emulate_rig(Footage& footage, const std::pair<std::string, py::dict>& rig_of,
                     const std::filesystem::path& output, bool force, const py::object& tell) {
    RigEmulation rig(rig_of.first, settings_of(rig_of.second), footage.shape(), footage.filter());
    const SensorSetup& first = rig.first();
    warn(mosaic_warning(first, footage.filter()));
    footage.warn_of(first.params);
    ResampledFootage slots = footage.resampled(first.params.slot_us);
    const FootageOrigin origin = footage.origin();
    creating(output, [&] { rig.begin(output, force, origin); });
    CallProgress progress(tell, slots.slots());
    {
        const py::gil_scoped_release released;
        for (auto frame = slots.next(); !frame.empty(); frame = slots.next()) {
            rig.expose(frame);
            if (!progress.reach(static_cast<double>(rig.slots()))) break;
        }
    }
    progress.finish();
    if (rig.slots() == 0) throw InputError(footage.name(), "is shorter than a slot of the sensor");
    rig.finish(check_signals);
    footage.pass_warnings_on(&first.params);
    return rig_figures(rig);
}

}  // namespace

void bind_rig(py::module_& module) {
    module.def("emulate_rig", &emulate_rig);
    module.def("is_rig_folder", &is_rig_folder);
}

}  // namespace stipple::python
