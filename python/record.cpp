#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "capture/capture_end.h"
#include "capture/open_camera.h"
#include "core/error.h"
#include "io/output_names.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/camera.h"
#include "python/errors.h"
#include "python/footage.h"
#include "python/recording.h"
#include "python/stream.h"

namespace stipple::python {
namespace fs = std::filesystem;
namespace {

using namespace pybind11::literals;

/// The value of `create()`, which opens the camera of the task and creates `file`. Without the GIL.
/// \throws FileError where one of the files cannot be opened or created.
template <typename Create>
auto creating_from_camera(const CameraTask& task, const fs::path& file, Create&& create) {
    try {
        return opening(task, std::forward<Create>(create));
    } catch (const InputError& error) {
        if (error.where().text() == file.string()) check_creatable(file, error);
        throw;
    }
}

py::dict recording_dict(const std::string& file, const CameraRecording& recording) {
    return py::dict("file"_a = file, "frames"_a = recording.end.frames,
                    "incomplete"_a = recording.end.incomplete,
                    "repeated"_a = recording.session.repeated,
                    "lost"_a = lost_dict(recording.session),
                    "missing_before_first"_a = recording.session.missing_before_first,
                    "outages"_a = recording.session.outages,
                    "transport"_a = transport_dict(recording.transport),
                    "payload_bytes"_a = recording.end.payload_bytes,
                    "seconds"_a = recording.seconds, "frames_hz"_a = recording.frames_hz);
}

RecordingFile record(const CameraTask& task, const fs::path& file, bool force,
                     const py::object& tell) {
    check_name(file, kRecordingName);
    SessionWarnings warnings;
    std::unique_ptr<CameraRecorder> recorder;
    {
        const py::gil_scoped_release released;
        recorder = creating_from_camera(task, file, [&] {
            return std::make_unique<CameraRecorder>(
                task.opener(), task.settings, file,
                CameraRecorderOptions{
                    .session = task.session,
                    .limits = task.limits,
                    .force = force,
                    .tell = [&](const SessionEvent& event) { warnings.take(event); }});
        });
    }
    for (const Message& text : recorder->description().warnings) warn(text);
    CallProgress progress(tell, task.limits.total(), CallProgress::Early::kYes);
    CameraRecording recording;
    {
        const py::gil_scoped_release released;
        recording = recorder->record([&](std::uint64_t frames, const SessionTotals& /*totals*/) {
            return progress.reach(static_cast<double>(frames));
        });
        static_cast<void>(progress.reach(static_cast<double>(recording.end.frames)));
    }
    warnings.pass_on();
    progress.finish();
    throw_early_end(recording, task.address);
    return open_recording(file, recording_dict(file.string(), recording));
}

std::unique_ptr<StreamFile> record_coded(const CameraTask& task, const fs::path& file, bool force,
                                         const py::object& tell) {
    check_name(file, kStreamName);
    std::unique_ptr<CodedRecorder> recorder;
    {
        const py::gil_scoped_release released;
        recorder = creating_from_camera(task, file, [&] {
            return std::make_unique<CodedRecorder>(
                open_camera(task.address, task.settings, task.buffers), file, force, task.limits);
        });
    }
    CallProgress progress(tell, recorder->slots(), CallProgress::Early::kYes);
    CodedRecording recording;
    {
        const py::gil_scoped_release released;
        recording = recorder->record([&](const CodedRecording& now) {
            return progress.reach(static_cast<double>(now.slots));
        });
        static_cast<void>(progress.reach(static_cast<double>(recording.slots)));
    }
    progress.finish();
    throw_early_end(recording, task.address);
    return std::make_unique<StreamFile>(
        file, py::dict("slots"_a = recording.slots, "missing_slots"_a = recording.missing_slots,
                       "damaged_frames"_a = recording.damaged_frames));
}

}  // namespace

void bind_record(py::module_& module) {
    module.def("record", &record);
    module.def("record_coded", &record_coded);
}

}  // namespace stipple::python
