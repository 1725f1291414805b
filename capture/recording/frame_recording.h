#pragma once

#include <cstdint>
#include <exception>
#include <string>

#include "capture/recording/recording_format.h"
#include "capture/recording/recording_writer.h"
#include "io/pending_output.h"

namespace stipple {

/// The record of a session that begins now; `settings` are what the camera was set to.
[[nodiscard]] SessionRecord session_record(const CameraDescription& camera,
                                           const CameraSettings& settings);

/// The name of a recording that begins now: its time, UTC, to the millisecond.
[[nodiscard]] std::string recording_name_now();

/// What became of a recording's file.
struct RecordingResult {
    RecordingEnd end;                 ///< as it stands in the file
    bool kept = false;                ///< the file is in place; it is where a frame is in it
    std::exception_ptr failure = {};  ///< of the disk (DeviceError), or no memory
};

/// A .strec file that is being made: a thread writes the frames. Used from one thread.
class FrameRecording {
  public:
    /// `output` must outlive it. \throws DeviceError as RecordingWriter.
    FrameRecording(PendingOutput& output, const SessionRecord& session, const WaitingFrames& most,
                   RecordingQueue::GiveBack give_back = {});

    /// Never waits for the disk. False, and nothing done to `frame`, if the disk is too slow.
    bool push(CapturedFrame&& frame);
    /// True after a failed write: further frames are dropped.
    [[nodiscard]] bool failed() const { return queue_.failed(); }

    /// Writes the waiting frames and puts the file in place, as far as it goes. `end` has the
    /// reason, the losses of the session and the counts of the transport; `failure` is what has
    /// ended the recording, if something has. \throws DeviceError, std::bad_alloc if it cannot be
    /// put in place. Called once.
    [[nodiscard]] RecordingResult finish(RecordingEnd end, std::exception_ptr failure = {});

  private:
    PendingOutput& output_;
    RecordingWriter writer_;
    RecordingQueue queue_;
    std::uint64_t refused_ = 0;  ///< frames that the queue had no room for
};

}  // namespace stipple
