#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "capture/capture_session.h"
#include "capture/frame_queue.h"

namespace stipple {

struct LiveCameraOptions {
    SessionOptions session;
    static constexpr std::size_t kMaxWaitingFrames = 4096;
    std::size_t waiting_frames = 64;  ///< 1 to kMaxWaitingFrames
    bool from_start = false;  ///< replay: frames wait for `begin`, so that the first one is used
    /// Called for outages, recoveries and the end, by the thread that receives the frames.
    std::function<void(const SessionEvent&)> tell;
};

/// A camera with a thread that receives its frames, and a queue of `waiting_frames` frames, fewer
/// if `max_memory` demands it (waiting_frames); then the description has a warning. A full queue
/// drops frames; the record of the next frame has their number (kQueueDrop). The memory of all
/// frames is allocated at the start, and frames are moved, not copied, so the resident memory does
/// not depend on how many wait.
class LiveCamera {
  public:
    /// Opens and starts the camera. Frames before `begin` are discarded, except with `from_start`.
    /// \throws InputError, DeviceError; InputError if `max_memory` has no room for one frame.
    LiveCamera(CaptureSession::Opener open, LiveCameraOptions options);
    ~LiveCamera();
    LiveCamera(const LiveCamera&) = delete;
    LiveCamera& operator=(const LiveCamera&) = delete;

    /// Layout when the camera was opened; each frame has its own.
    [[nodiscard]] const FrameLayout& layout() const { return layout_; }
    [[nodiscard]] const CameraDescription& description() const { return description_; }

    void begin();
    /// Replaces `frame`, whose memory is used again, by the next one. Returns false after the
    /// timeout, or if the camera is lost for good. Rethrows an exception of the receiving thread
    /// (no memory).
    [[nodiscard]] bool next(CapturedFrame& frame, std::chrono::milliseconds timeout);
    /// Why no further frame will come; empty as long as one may come.
    [[nodiscard]] std::optional<DeviceLost> end() const;
    /// Maximum number of frames that waited.
    [[nodiscard]] std::size_t peak() const { return frames_.peak(); }
    /// Number of frames whose memory was not allocated at the start. 0 as long as the camera keeps
    /// its layout and the caller holds one frame.
    [[nodiscard]] std::uint64_t late_allocations() const { return session_.late_allocations(); }
    /// Stops the camera. Returns the counts of its frames.
    SessionTotals stop();
    /// Precondition: it is stopped.
    [[nodiscard]] TransportCounts transport() const { return session_.transport(); }

  private:
    [[nodiscard]] std::size_t plan_queue(const Camera& camera);
    void run(const std::stop_token& stop) noexcept;
    void take(SessionEvent event);

    LiveCameraOptions options_;
    WaitingFrames waiting_;
    Message short_queue_;     ///< a warning; empty if it has the wanted length
    CaptureSession session_;  ///< behind what is planned when it opens the camera
    FrameLayout layout_;
    CameraDescription description_;
    FrameQueue frames_;
    std::atomic<bool> begun_ = false;
    std::optional<DeviceLost> end_;  ///< the thread's, until the frames have ended
    std::exception_ptr failure_;     ///< the same
    std::jthread thread_;            ///< last: it uses the other members
};

}  // namespace stipple
