#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <utility>

#include "capture/camera.h"
#include "capture/frame_record.h"

namespace stipple {

/// Frames that are missing before the next one, by cause.
struct FrameGap {
    LostFrames lost{};

    void add(GapCause cause, std::uint64_t frames) {
        lost[static_cast<std::size_t>(cause)] += frames;
    }
    [[nodiscard]] std::uint64_t total() const;
    /// Of most of them.
    [[nodiscard]] GapCause cause() const;
};

/// The cause of a loss, by what the transport had counted before and after it. `incomplete_frames`:
/// whether frames have arrived incomplete meanwhile; their packets explain the loss of no others.
[[nodiscard]] GapCause cause_of(const TransportCounts& before, const TransportCounts& after,
                                bool incomplete_frames);

/// Missing frames of a session by their cause, which the counters of the transport tell. An epoch
/// lasts from opening the camera to losing it; its counters begin with 0.
class LossCounter {
  public:
    using Clock = std::chrono::steady_clock;
    /// How often the transport's counters are read while nothing is amiss: reading them costs more
    /// than a frame of a fast camera does.
    static constexpr std::chrono::milliseconds kCountEvery{200};

    void begin_epoch(Clock::time_point now);
    void end_epoch(const Camera& camera, Clock::time_point now);
    /// After a frame with which none is missing.
    void note_frame(const Camera& camera, Clock::time_point now);
    /// An incomplete frame: its packets explain the loss of no other frame.
    void note_incomplete() { incomplete_since_ = true; }
    /// Counts frames as lost for the cause that the transport has counted since the last reading.
    void count_unexplained(const Camera& camera, std::uint64_t frames, Clock::time_point now);
    void count(GapCause cause, std::uint64_t frames);
    /// Of a frame that is dropped: those that were missing before it are missing before the next.
    void add_to_gap(GapCause cause, std::uint64_t frames) { gap_.add(cause, frames); }
    /// After the last frame of a replay: no further frame will tell that some are missing.
    void count_last_underruns(const Camera& camera, Clock::time_point now);

    /// The frames missing since the last call.
    [[nodiscard]] FrameGap take_gap() { return std::exchange(gap_, {}); }
    /// By GapCause, of the whole session.
    [[nodiscard]] const LostFrames& lost() const { return lost_; }
    /// Sum over the epochs that have ended, and of `camera` if it is not null.
    [[nodiscard]] TransportCounts transport(const Camera* camera) const;

  private:
    void read(const Camera& camera, Clock::time_point now);

    FrameGap gap_;
    LostFrames lost_{};
    TransportCounts earlier_epochs_;
    TransportCounts counted_;  ///< of this epoch, at `counted_at_`
    Clock::time_point counted_at_;
    bool incomplete_since_ = false;  ///< an incomplete frame since `counted_at_`
};

}  // namespace stipple
