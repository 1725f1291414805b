#pragma once

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "capture/recording/recording_writer.h"

namespace stipple {

/// Queue between a camera and a disk that may be slower for a while; a thread writes the frames. A
/// full queue drops frames and counts them. The caller reports each drop to
/// CaptureSession::count_own_drop, which notes it in the record of the next frame.
class RecordingQueue {
  public:
    /// `writer` must outlive the queue; nobody else uses it before `drain` has returned. The queue
    /// holds up to `max_bytes` of frames, and at least one frame.
    RecordingQueue(RecordingWriter& writer, std::size_t max_bytes);
    /// Writes the waiting frames, as far as possible.
    ~RecordingQueue();
    RecordingQueue(const RecordingQueue&) = delete;
    RecordingQueue& operator=(const RecordingQueue&) = delete;

    /// Never waits for the disk. False if the frame was dropped.
    bool push(CapturedFrame&& frame);
    /// True after a failed write: further frames are dropped, `drain` throws the reason.
    [[nodiscard]] bool failed() const;
    /// Writes the waiting frames and stops. \throws the exception of a failed write: DeviceError,
    /// std::bad_alloc.
    void drain();

    [[nodiscard]] std::uint64_t dropped() const;
    /// Maximum number of waiting bytes.
    [[nodiscard]] std::size_t peak_bytes() const;

  private:
    void run();
    void stop();

    RecordingWriter& writer_;
    std::size_t max_bytes_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<CapturedFrame> frames_;
    std::size_t bytes_ = 0;  ///< waiting or being written
    std::size_t peak_bytes_ = 0;
    std::uint64_t dropped_ = 0;
    bool stopping_ = false;
    std::exception_ptr failure_;
    std::thread thread_;  ///< last: it uses the other members
};

}  // namespace stipple
