#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>

#include "core/error.h"
#include "io/disk_sync.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/emulation.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "python/stream.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"

namespace stipple::python {
namespace {

using namespace pybind11::literals;

/// What the readout cost: the key `readout` of "emulate" in docs/cli.md.
py::dict readout_dict(const ReadoutAccount& account, double light_throughput) {
    const ReadoutCounts& totals = account.totals();
    const auto clocks = static_cast<double>(account.clocks());
    const auto slots = static_cast<double>(account.slots());
    const double seconds = clocks / static_cast<double>(account.timing().clock_hz);
    const int rows = account.shape().rows + account.timing().dark_rows;
    const bool drops = account.budget().policy == OverrunPolicy::kDrop;
    return py::dict(
        "overrun_policy"_a = drops ? "drop" : "stretch", "slot_clocks"_a = account.budget().clocks,
        "clocks"_a = account.clocks(), "seconds"_a = seconds, "sensor_slots_hz"_a = slots / seconds,
        "overrun_slots"_a = account.overruns(), "dropped_samples"_a = totals.dropped_samples,
        "readout_clocks"_a = totals.readout_clocks, "rows_read"_a = totals.rows,
        "conversions"_a = totals.conversions, "transferred_samples"_a = totals.transferred,
        "link_bits"_a = totals.bits,
        "row_utilisation"_a = static_cast<double>(totals.rows) / (slots * rows),
        "adc_utilisation"_a = static_cast<double>(totals.convert_clocks) / clocks,
        "link_utilisation"_a = static_cast<double>(totals.link_clocks) / clocks,
        "energy_uj"_a = totals.energy_pj * 1e-6,
        "sample_energy_pj"_a = totals.energy_pj / static_cast<double>(totals.samples),
        "light_throughput"_a = light_throughput,
        "schedule_memory_bits"_a = schedule_memory_bits(account.schedule()),
        "code_load_bits_per_second"_a =
            static_cast<double>(account.shape().pixels()) * (slots / seconds));
}

}  // namespace

py::dict figures_of(const StreamRecorder& recorder) {
    py::dict figures("slots"_a = recorder.stats().slots, "samples"_a = recorder.samples(),
                     "payload_bits"_a = recorder.payload_bits(),
                     "compression_ratio"_a = recorder.compression_ratio(),
                     "light_throughput"_a = recorder.light_throughput(),
                     "light_read"_a = recorder.light_read(),
                     "saturated_fraction"_a = recorder.saturated_fraction());
    if (const ReadoutAccount* account = recorder.account())
        figures["readout"] = readout_dict(*account, recorder.light_throughput());
    return figures;
}

OverrunPolicy overrun_policy(const std::string& name) {
    if (name != "stretch" && name != "drop")
        throw InputError("overrun", "\"" + name + "\" is none of stretch, drop");
    return name == "drop" ? OverrunPolicy::kDrop : OverrunPolicy::kStretch;
}

namespace {

/// A sensor with its schedule for some footage.
SensorSetup set_up_for(const Footage& footage, const py::object& sensor, const py::object& schedule,
                       std::uint64_t seed, const std::string& overrun) {
    SensorChoice choice = sensor_of(sensor).choice;
    choice.seed = seed;
    choice.overrun = overrun_policy(overrun);
    return set_up(choice, schedule, footage.shape(), footage.filter());
}

/// Makes the stream file, and returns its figures.
py::dict write_stream(Footage& footage, const SensorSetup& setup, const py::object& tell,
                      const std::filesystem::path& file, bool force) {
    const std::string provenance = provenance_of(setup, footage.origin());
    const auto recorder = creating(
        file, [&] { return std::make_unique<StreamRecorder>(file, force, setup, provenance); });
    CallProgress progress(tell, footage.slots());
    {
        const py::gil_scoped_release released;
        double done = 0;
        for (auto frame = footage.next(); !frame.empty(); frame = footage.next()) {
            recorder->expose(frame);
            if (!progress.reach(++done)) break;
        }
    }
    progress.finish();
    {
        const py::gil_scoped_release released;
        recorder->finish();
    }
    return figures_of(*recorder);
}

std::unique_ptr<StreamFile> emulate(Footage& footage, const SensorSetup& setup,
                                    const std::optional<std::filesystem::path>& output, bool force,
                                    const py::object& tell) {
    warn(mosaic_warning(setup, footage.filter()));
    std::unique_ptr<StreamFile> stream;
    if (output) {
        const py::dict figures = write_stream(footage, setup, tell, *output, force);
        stream = std::make_unique<StreamFile>(*output, figures);
    } else {
        const NoSync no_sync;
        auto file = std::make_unique<TemporaryFile>();
        const py::dict figures = write_stream(footage, setup, tell, file->path(), false);
        file->unname();
        stream = std::make_unique<StreamFile>(std::move(file), figures);
    }
    footage.pass_warnings_on();
    return stream;
}

}  // namespace

void bind_emulate(py::module_& module) {
    py::class_<SensorSetup>(module, "Setup").def(py::init(&set_up_for));
    module.def("emulate", &emulate);
}

}  // namespace stipple::python
