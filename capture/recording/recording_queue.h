#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "capture/recording/recording_writer.h"

namespace stipple {

/// Between a camera and a disk that may be slower for a while: a thread writes what `push` took.
/// When the queue is full, frames are dropped and counted; whoever numbers the frames says so in
/// the record of the next one (CaptureSession::count_own_drop).
class RecordingQueue {
  public:
    /// `writer` must outlive the queue and belongs to it until `drain` has returned. The queue
    /// holds frames of `max_bytes` in all, and one at least.
    RecordingQueue(RecordingWriter& writer, std::size_t max_bytes);
    /// Writes what waits, as far as it can be written.
    ~RecordingQueue();
    RecordingQueue(const RecordingQueue&) = delete;
    RecordingQueue& operator=(const RecordingQueue&) = delete;

    /// Never waits for the disk. False if the frame was dropped.
    bool push(CapturedFrame&& frame);
    /// True once a write has failed: all further frames are dropped, `drain` tells why.
    [[nodiscard]] bool failed() const;
    /// Writes what waits and stops. \throws what a write that failed has thrown, now or before:
    /// DeviceError, std::bad_alloc.
    void drain();

    [[nodiscard]] std::uint64_t dropped() const;
    /// The most bytes that ever waited.
    [[nodiscard]] std::size_t peak_bytes() const;

  private:
    void run();
    void stop();

    RecordingWriter& writer_;
    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<CapturedFrame> frames_;
    std::size_t bytes_ = 0;  ///< waiting, and the frame that is being written
    std::size_t peak_bytes_ = 0;
    std::uint64_t dropped_ = 0;
    bool stopping_ = false;
    std::exception_ptr failure_;
    std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace stipple
