#pragma once

#include <optional>
#include <utility>

#include "capture/camera.h"
#include "capture/frame_ids.h"
#include "capture/frame_record.h"

namespace stipple {

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
