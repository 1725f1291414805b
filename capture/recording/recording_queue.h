#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <thread>

#include "capture/frame_queue.h"
#include "capture/recording/recording_writer.h"

namespace stipple {

/// Between a camera and a disk that may be slower for a while: a thread writes what `push` took.
/// When the queue is full, frames are dropped and counted; whoever numbers the frames says so in
/// the record of the next one (CaptureSession::count_own_drop).
class RecordingQueue {
  public:
    /// `writer` must outlive the queue and belongs to it until `drain` has returned. Frames
    /// of `max_bytes` in all, and one at least, wait beside the one that is being written.
    RecordingQueue(RecordingWriter& writer, std::size_t max_bytes);
    /// Writes what waits, as far as it can be written.
    ~RecordingQueue();
    RecordingQueue(const RecordingQueue&) = delete;
    RecordingQueue& operator=(const RecordingQueue&) = delete;

    /// Never waits for the disk. False if the frame was dropped.
    bool push(CapturedFrame&& frame);
    /// True once a write has failed: all further frames are dropped, `drain` tells why.
    [[nodiscard]] bool failed() const { return failed_; }
    /// Writes what waits and stops. \throws what a write that failed has thrown, now or before:
    /// DeviceError, std::bad_alloc.
    void drain();

    [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

  private:
    void run();
    void stop();

    RecordingWriter& writer_;
    FrameQueue frames_;
    std::atomic<std::uint64_t> dropped_ = 0;
    std::atomic<bool> failed_ = false;
    std::exception_ptr failure_;  ///< the thread's, until it has ended
    std::thread thread_;          ///< last: starts when all else is there
};

}  // namespace stipple
