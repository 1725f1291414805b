#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "capture/live_camera.h"
#include "core/error.h"
#include "python/bindings.h"
#include "python/call_progress.h"
#include "python/camera.h"
#include "python/footage.h"

namespace stipple::python {
namespace {

/// The frames of a camera that runs, handed over without a copy.
class CameraFrames {
  public:
    CameraFrames(CameraTask task, std::size_t queue_frames) : task_(std::move(task)) {
        const py::gil_scoped_release released;
        LiveCameraOptions options{.session = task_.session,
                                  .waiting_frames = queue_of(queue_frames),
                                  .from_start = task_.is_replay(),
                                  .tell = {}};
        options.tell = [this](const SessionEvent& event) { warnings_.take(event); };
        opening(task_, [&] { return &camera_.emplace(task_.opener(), std::move(options)); });
        camera_->begin();
    }

    /// The next frame. \throws stop_iteration at the end, DeviceError if the camera is lost.
    std::unique_ptr<CapturedFrame> next() {
        while (camera_) {
            auto frame = std::make_unique<CapturedFrame>();
            bool came = false;
            {
                const py::gil_scoped_release released;
                came = camera_->next(*frame, kSignalInterval);
            }
            check_signals();
            warnings_.pass_on();
            if (came) return frame;
            if (const auto end = camera_->end()) {
                close();
                throw_end(*end);
                break;
            }
        }
        throw py::stop_iteration();
    }

    void close() {
        const py::gil_scoped_release released;
        camera_.reset();
    }

  private:
    void throw_end(const DeviceLost& end) const {
        if (end.bad_file) throw InputError(*end.bad_file);
        if (!end.at_end) throw DeviceError(task_.address, "camera lost: " + end.reason);
    }

    CameraTask task_;
    SessionWarnings warnings_;
    std::optional<LiveCamera> camera_;
};

}  // namespace

void bind_camera_frames(py::module_& module) {
    py::class_<CameraFrames>(module, "CameraFrames")
        .def(py::init<CameraTask, std::size_t>())
        .def("__iter__", [](const py::object& self) { return self; })
        .def("__next__", &CameraFrames::next)
        .def("__enter__", [](const py::object& self) { return self; })
        .def("__exit__", [](CameraFrames& self, const py::args& /*exception*/) { self.close(); })
        .def("close", &CameraFrames::close, "Stops the camera and closes it.");
}

}  // namespace stipple::python
