#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

#include "capture/frame_queue.h"
#include "capture/recording/recording_writer.h"

namespace stipple {

/// Queue between a camera and a disk that may be slower for a while; a thread writes the frames. A
/// full queue drops frames and counts them. The caller reports each drop to
/// CaptureSession::count_queue_drop, which notes it in the record of the next frame.
class RecordingQueue {
  public:
    /// Takes the memory of a frame that is written.
    using GiveBack = std::function<void(std::vector<std::uint8_t>&& payload)>;

    /// `writer` must outlive the queue; nobody else uses it before `drain` has returned. The queue
    /// holds so many frames, and at least one. Its thread calls `give_back`, which may be empty.
    RecordingQueue(RecordingWriter& writer, const WaitingFrames& most, GiveBack give_back = {});
    /// Writes the waiting frames, as far as possible.
    ~RecordingQueue();
    RecordingQueue(const RecordingQueue&) = delete;
    RecordingQueue& operator=(const RecordingQueue&) = delete;

    /// Never waits for the disk. False if the frame was dropped.
    bool push(CapturedFrame&& frame);
    /// True after a failed write: further frames are dropped, `drain` throws the reason.
    [[nodiscard]] bool failed() const { return failed_; }
    /// Writes the waiting frames and stops. \throws the exception of a failed write: DeviceError,
    /// std::bad_alloc.
    void drain();

    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    void run();
    void stop();

    RecordingWriter& writer_;
    FrameQueue frames_;
    GiveBack give_back_;
    std::atomic<std::uint64_t> dropped_ = 0;
    std::atomic<bool> failed_ = false;
    std::exception_ptr failure_;  ///< the thread's, until it has ended
    std::thread thread_;          ///< last: it uses the other members
};

}  // namespace stipple
