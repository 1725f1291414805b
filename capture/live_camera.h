#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>

#include "capture/capture_session.h"
#include "capture/frame_queue.h"

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
    [[nodiscard]] std::size_t peak() const { return frames_.peak(); }
    /// Stops the camera. What became of its frames.
    SessionTotals stop();
    /// Precondition: it is stopped.
    [[nodiscard]] TransportCounts transport() const { return session_.transport(); }

  private:
    void run(const std::stop_token& stop) noexcept;
    void take(SessionEvent event);

    LiveCameraOptions options_;
    CaptureSession session_;
    FrameLayout layout_;
    CameraDescription description_;
    FrameQueue frames_;
    std::atomic<bool> begun_ = false;
    std::optional<DeviceLost> end_;  ///< the thread's, until the frames have ended
    std::exception_ptr failure_;     ///< the same
    std::jthread thread_;            ///< last: starts when all else is there
};

}  // namespace stipple
