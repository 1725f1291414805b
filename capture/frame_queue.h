#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>

#include "capture/camera.h"
#include "capture/frame_record.h"
#include "core/message.h"

namespace stipple {

/// Frames between a camera, which never waits, and a thread that may be slower for a while: what
/// the queue has no room for is the caller's to drop.
class FrameQueue {
  public:
    /// Holds so many frames and bytes at most, but one frame in any case.
    FrameQueue(std::size_t max_frames, std::size_t max_bytes)
        : max_frames_(max_frames), max_bytes_(max_bytes) {}

    /// False, and nothing done to `frame`, if there is no room for it or the queue is closed.
    bool push(CapturedFrame&& frame);
    /// The oldest frame; waits for one while the queue is open, with `timeout` not longer than
    /// that.
    [[nodiscard]] std::optional<CapturedFrame> pop();
    [[nodiscard]] std::optional<CapturedFrame> pop(std::chrono::milliseconds timeout);
    /// From now on there are no frames but those that wait.
    void close();
    /// The same, and drops those that wait. Returns how many.
    std::size_t close_and_clear();

    /// Closed and empty.
    [[nodiscard]] bool ended() const;
    [[nodiscard]] std::size_t max_frames() const { return max_frames_; }
    /// The most frames that ever waited.
    [[nodiscard]] std::size_t peak() const;

  private:
    [[nodiscard]] bool can_pop() const { return closed_ || !frames_.empty(); }
    [[nodiscard]] std::optional<CapturedFrame> take_oldest();

    std::size_t max_frames_;
    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<CapturedFrame> frames_;
    std::size_t bytes_ = 0;
    std::size_t peak_ = 0;
    bool closed_ = false;
};

/// Frames that may wait behind a camera for a slower consumer.
struct WaitingFrames {
    std::size_t frames = std::numeric_limits<std::size_t>::max();
    std::size_t bytes = std::numeric_limits<std::size_t>::max();
};

/// The wanted ones, or fewer: with the buffers of the open camera and the frames that are not in
/// the queue (of the session, and one in use) they take no more than `max_memory`. \throws
/// InputError if that leaves no room for a single frame.
[[nodiscard]] WaitingFrames waiting_frames(const Camera& camera, const WaitingFrames& wanted);

/// Warns that fewer frames may wait than were wanted.
[[nodiscard]] Message short_queue_text(const Camera& camera, std::size_t frames,
                                       std::size_t wanted);

}  // namespace stipple
