#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "capture/capture_session.h"

namespace stipple {

struct LiveCameraOptions {
    SessionOptions session;
    std::size_t waiting_frames = 64;
    bool from_start = false;  ///< frames wait for `begin`: of a replay, whose first one counts
    /// Told of outages, recoveries and the end, by the thread that takes the frames.
    std::function<void(const SessionEvent&)> tell;
};

/// A camera whose frames a thread takes and keeps, a few of them, until somebody has time. When as
/// many as that wait, or as `max_memory` holds, further ones are dropped; the next frame says how
/// many (kOwnDrop).
class LiveCamera {
  public:
    /// Opens and starts the camera; until `begin`, its frames are let go, unless they wait.
    /// \throws InputError, DeviceError.
    LiveCamera(CaptureSession::Opener open, LiveCameraOptions options);
    ~LiveCamera();
    LiveCamera(const LiveCamera&) = delete;
    LiveCamera& operator=(const LiveCamera&) = delete;

    /// As the camera was opened; every frame says its own.
    [[nodiscard]] const FrameLayout& layout() const { return layout_; }
    [[nodiscard]] const CameraDescription& description() const { return description_; }

    void begin();
    /// The next frame; nothing if none comes in time or the camera is lost for good. Rethrows what
    /// kept the frames from being taken: no memory.
    [[nodiscard]] std::optional<CapturedFrame> next(std::chrono::milliseconds timeout);
    /// Why no frame will come any more; nothing while one may.
    [[nodiscard]] std::optional<DeviceLost> end() const;
    /// Frames that waited at most.
    [[nodiscard]] std::size_t peak() const;
    /// Stops the camera. What became of its frames.
    SessionTotals stop();
    /// Precondition: it is stopped.
    [[nodiscard]] TransportCounts transport() const { return session_.transport(); }

  private:
    void run(const std::stop_token& stop) noexcept;
    void take(CapturedFrame frame);

    LiveCameraOptions options_;
    CaptureSession session_;
    FrameLayout layout_;
    CameraDescription description_;
    std::size_t most_;
    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<CapturedFrame> frames_;
    std::size_t peak_ = 0;
    bool begun_ = false;
    std::optional<DeviceLost> end_;
    std::exception_ptr failure_;  ///< of the thread
    std::jthread thread_;         ///< last: starts when all else is there
};

}  // namespace stipple
