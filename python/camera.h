#pragma once

#include <pybind11/pytypes.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "capture/camera.h"
#include "capture/capture_session.h"
#include "capture/recording/replay_camera.h"
#include "python/errors.h"

namespace stipple::python {

/// A camera that Python has chosen, and how it is used.
struct CameraTask {
    std::string address;
    CameraSettings settings;
    CameraBuffers buffers;
    SessionOptions session;
    CaptureLimits limits;

    /// Opens it for its images; may be called without the GIL.
    [[nodiscard]] CaptureSession::Opener opener() const;
    [[nodiscard]] bool is_replay() const;
};

/// The value of `open()`, which opens the camera of the task. \throws FileError where it is a
/// replay whose file cannot be opened.
template <typename Open>
auto opening(const CameraTask& task, Open&& open) {
    try {
        return std::forward<Open>(open)();
    } catch (const InputError& error) {
        const auto file = replayed_file(task.address);
        if (!file.empty()) check_readable(file, error);
        throw;
    }
}

/// The argument `queue`: frames that may wait. \throws InputError if it is out of range.
[[nodiscard]] std::size_t queue_of(std::size_t frames);

/// Interval at which a wait looks for Ctrl-C.
inline constexpr std::chrono::milliseconds kSignalInterval{100};

/// What a session tells from its own threads, for a warning in Python.
class SessionWarnings {
  public:
    /// Without the GIL.
    void take(const SessionEvent& event);
    void take(Message text);
    /// Has Python warn. With the GIL.
    void pass_on();

  private:
    std::mutex mutex_;
    std::vector<Message> texts_;
};

/// Missing frames by cause, and the counts of the transport: the keys `lost` and `transport` of
/// docs/outputs.md.
[[nodiscard]] pybind11::dict lost_dict(const SessionTotals& totals);
[[nodiscard]] pybind11::dict transport_dict(const TransportCounts& counts);

}  // namespace stipple::python
