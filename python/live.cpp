#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "capture/capture_end.h"
#include "capture/capture_figures.h"
#include "capture/live_emulator.h"
#include "capture/sensor_warnings.h"
#include "core/error.h"
#include "io/disk_sync.h"
#include "io/output_names.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/camera.h"
#include "python/emulation.h"
#include "python/errors.h"
#include "python/figures_dict.h"
#include "python/footage.h"
#include "python/live_preview.h"
#include "python/schedule.h"
#include "python/sensor.h"
#include "python/stream.h"
#include "readout/emulation_figures.h"
#include "readout/emulator.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

/// The sensor behind a camera, how late it may be, and who watches.
struct LiveTask {
    ChosenSensor sensor;
    py::object schedule;
    double black_level_dn;
    std::size_t queue_frames;
    double late_after_slots;
    std::optional<PreviewTask> preview;
};

/// The keys of "capture live" in docs/outputs.md.
py::dict live_dict(const LiveEmulation& live, const StreamRecorder& recorder,
                   const LiveCamera& camera) {
    py::dict dict = figures_of(recorder);
    dict.attr("update")(dict_of([&](const auto& add) {
        visit_speed_figures(recorder, live.slots_per_second, add);
        visit_live_figures({live, recorder, camera}, add);
    }));
    return dict;
}

/// A camera that is opened for a live emulation, and the sensor behind it.
struct LiveSetup {
    LiveSetup(const CameraTask& task, const LiveTask& live)
        : camera(task.opener(),
                 {.session = task.session,
                  .waiting_frames = live.queue_frames,
                  .from_start = task.is_replay(),
                  .tell = [this](const SessionEvent& event) { warnings.take(event); }}),
          to_light(camera.layout(), live.black_level_dn) {}

    SessionWarnings warnings;
    LiveCamera camera;
    FrameLight to_light;
    std::optional<ShownPreview> preview;
};

/// Emulates until the camera, a limit or Python ends it, and puts the stream in place.
LiveEmulation emulate_live(const CameraTask& task, const LiveTask& live, LiveSetup& setup,
                           StreamRecorder& recorder, CallProgress& progress) {
    SessionWarnings& warnings = setup.warnings;
    const py::gil_scoped_release released;
    LiveEmulatorOptions options{.limits = task.limits, .late_after_slots = live.late_after_slots};
    options.tell = [&](const LeftOut& left_out) {
        warnings.take(left_out_text(task.address, left_out));
    };
    if (auto& preview = setup.preview)
        options.show = [&](const LiveSlot& slot) { preview->add(slot.packets, slot.arrival_ns); };
    LiveEmulator emulator(setup.camera, setup.to_light, recorder, std::move(options));
    bool goes_on = true;
    LiveEmulation result = emulator.run([&](const LiveEmulation& now) {
        goes_on = progress.reach(static_cast<double>(now.latencies.count())) &&
                  (!setup.preview || setup.preview->pass_on());
        return goes_on;
    });
    static_cast<void>(progress.reach(static_cast<double>(result.latencies.count())));
    result.totals.repeated = setup.camera.stop().repeated;
    if (result.latencies.count() == 0) return result;
    warnings.take(camera_rate_warning(result.rate, recorder.emulator().setup().params));
    commit_recording(recorder, result);
    if (setup.preview) setup.preview->finish(!goes_on);
    return result;
}

py::dict write_live(const CameraTask& task, const LiveTask& live, const fs::path& file, bool force,
                    const py::object& tell) {
    check_name(file, kStreamName);
    std::unique_ptr<LiveSetup> camera;
    FootageOrigin origin;
    {
        const py::gil_scoped_release released;
        camera = opening(task, [&] { return std::make_unique<LiveSetup>(task, live); });
        origin = live_origin(task.address, camera->camera, live.black_level_dn, [] {});
    }
    const FrameLight& to_light = camera->to_light;
    const SensorSetup setup =
        set_up(live.sensor, live.schedule, to_light.shape(), to_light.filter());
    const auto recorder = creating(file, [&] {
        return std::make_unique<StreamRecorder>(
            file, setup,
            StreamRecorderOptions{.force = force, .provenance = provenance_of(setup, origin)});
    });
    for (const Message& text : camera->camera.description().warnings) warn(text);
    warn(mosaic_warning(setup, to_light.filter()));
    if (live.preview)
        camera->preview.emplace(*live.preview, stream_header_of(setup, {}), camera->warnings);
    CallProgress progress(tell, task.limits.total(), CallProgress::Early::kYes);
    const LiveEmulation result = emulate_live(task, live, *camera, *recorder, progress);
    camera->warnings.pass_on();
    progress.finish();
    if (camera->preview) camera->preview->throw_raised();
    throw_early_end(result, task.address);
    py::dict figures = live_dict(result, *recorder, camera->camera);
    if (camera->preview) figures["preview"] = camera->preview->figures();
    return figures;
}

std::unique_ptr<StreamFile> live(const CameraTask& task, const LiveTask& live,
                                 const std::optional<fs::path>& output, bool force,
                                 const py::object& tell) {
    if (output)
        return std::make_unique<StreamFile>(*output, write_live(task, live, *output, force, tell));
    const NoSync no_sync;
    auto file = std::make_unique<TemporaryFile>();
    const py::dict figures = write_live(task, live, file->path(), false, tell);
    file->unname();
    return std::make_unique<StreamFile>(std::move(file), figures);
}

}  // namespace

void bind_live(py::module_& module) {
    py::class_<LiveTask>(module, "LiveTask")
        .def(py::init([](const py::object& sensor, const py::object& schedule,
                         const py::object& seed, const std::string& overrun, double black_level_dn,
                         std::size_t queue_frames, double late_after_slots,
                         std::optional<PreviewTask> preview) {
            if (!(late_after_slots > 0))
                throw InputError("late_after", fmt::format("{} is not above 0", late_after_slots));
            LiveTask task{sensor_of(sensor),      schedule,         black_level_dn,
                          queue_of(queue_frames), late_after_slots, std::move(preview)};
            task.sensor.choice.seed = whole_in(seed, "seed");
            task.sensor.choice.overrun = overrun_policy(overrun);
            return task;
        }));
    module.def("live", &live);
}

}  // namespace stipple::python
