#pragma once

#include <cstdint>
#include <optional>
#include <utility>

#include "capture/camera.h"
#include "capture/frame_record.h"

namespace stipple {

/// Unwraps the frame ids of a camera to increasing 64-bit ids. The first frame has id 0. A gap of
/// more than half the period looks like a restart of the camera's counter, and counts as a restart.
class FrameIds {
  public:
    /// Wire ids count modulo `period` (Camera::wire_id_period). Precondition: period >= 2.
    explicit FrameIds(std::uint64_t period) : period_(period) {}

    struct Step {
        std::uint64_t id = 0;
        std::uint64_t lost = 0;  ///< skipped ids before it
        bool restarted = false;  ///< the counter of the camera restarted, or repeated an id
    };
    /// Takes the wire id of the next frame.
    [[nodiscard]] Step next(std::uint64_t wire_id) noexcept;

    /// Whether this wire id belongs to the last frame or to an earlier one, received or lost.
    [[nodiscard]] bool is_past(std::uint64_t wire_id) const noexcept;

    /// Number of ids from one wire id to another, modulo the period.
    [[nodiscard]] std::uint64_t steps(std::uint64_t from, std::uint64_t to) const noexcept;

    /// The camera restarts after `skipped` frames without ids.
    void restart(std::uint64_t period, std::uint64_t skipped = 0) noexcept;

  private:
    std::uint64_t period_;
    std::uint64_t next_id_ = 0;
    std::optional<std::uint64_t> last_wire_id_;
};

/// Leaves out frames that a camera or its transport delivers a second time. A frame with a past id
/// is a repeat, or the first one of a counter that began anew: it began anew if the stamp is newer
/// than that of the frame before, if a camera without stamps repeats the last id at once, or if the
/// next frame follows this one. Until that is known the frame is in doubt, and held.
class RepeatFilter {
  public:
    /// Each may be empty.
    struct Sorted {
        std::optional<CapturedFrame> next;  ///< the next frame in order
        std::optional<CapturedFrame>
            left_out;  ///< a repeat; if incomplete, one that is resent late
    };

    /// Takes the frame that has arrived. `ids` have numbered the frames up to `last`, the last one
    /// of them; null: all frames are new, after a reconnection or at the start.
    [[nodiscard]] Sorted take(CapturedFrame frame, const FrameIds& ids, const FrameRecord* last);

    /// A frame that is next in order without another arriving.
    [[nodiscard]] std::optional<CapturedFrame> take_waiting() {
        return std::exchange(waiting_, std::nullopt);
    }
    /// The frame in doubt, which is a repeat if no other follows.
    [[nodiscard]] std::optional<CapturedFrame> take_doubtful() {
        return std::exchange(doubtful_, std::nullopt);
    }

  private:
    [[nodiscard]] bool follows_doubtful(const FrameRecord& record, const FrameIds& ids) const;

    std::optional<CapturedFrame> doubtful_;
    std::optional<CapturedFrame> waiting_;  ///< which showed that `doubtful_` was no repeat
};

}  // namespace stipple
