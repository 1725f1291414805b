#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "capture/frame_queue.h"
#include "capture/recording/recording_format.h"
#include "stream/append_file.h"

namespace stipple {

/// Writes a recording (docs/recording_format.md): frames in their wire format, each with a record.
/// Every prefix of the file is readable up to its last whole frame. Used from one thread.
class RecordingWriter {
  public:
    /// Creates the file and writes the session record. `where` is the name of the output in
    /// messages (default: the path), for a file that is renamed when it is complete. \throws
    /// DeviceError.
    RecordingWriter(const std::filesystem::path& file, const SessionRecord& session,
                    std::string where = {});

    /// Appends a frame and computes the hash of its payload. Precondition: its layout has a format
    /// and at most 65535 x 65535 pixels, its holes are in ascending order and lie in the payload.
    /// \throws DeviceError (full disk): the file then ends with the previous frame. It is readable
    /// with or without a later `finish`.
    void write(const CapturedFrame& frame);

    /// Writes the end record and closes the file. `end` has the reason, the losses and the counts
    /// of the transport; `finish` adds frames, bytes and clocks. \throws DeviceError.
    void finish(RecordingEnd end);

    /// The values that `finish` adds (frames, incomplete, payload bytes, clocks), and the losses by
    /// the records of the frames, so far; after `finish`, the end record.
    [[nodiscard]] RecordingEnd totals() const;
    [[nodiscard]] std::uint64_t frames() const { return totals_.frames; }
    [[nodiscard]] std::uint64_t bytes_written() const { return file_.bytes(); }

  private:
    void append_block(BlockKind kind, std::span<const std::uint8_t> record,
                      std::span<const std::uint8_t> payload);
    void count(const FrameRecord& record, std::size_t payload_bytes);

    AppendFile file_;
    std::uint32_t blocks_ = 0;
    RecordingEnd totals_;
    std::vector<ClockFitter> clocks_;
};

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
