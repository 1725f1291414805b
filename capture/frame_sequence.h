#pragma once

#include <cstdint>
#include <optional>

#include "capture/frame_record.h"

namespace stipple {

/// Frame rate of a camera, with lost frames counted: number of periods between the first and the
/// last frame over the time between them, by device stamps, or by arrival if there are none. An
/// outage restarts the measurement, and so does an id or a stamp that goes back.
class FrameRate {
  public:
    void add(const FrameRecord& record);

    /// Time from the first to the last frame.
    [[nodiscard]] double seconds() const;
    [[nodiscard]] std::uint64_t periods() const;
    /// Empty until there are two frames.
    [[nodiscard]] std::optional<double> hz() const;

  private:
    std::optional<FrameRecord> first_;
    FrameRecord last_;
};

/// Frames of a camera in slots of equal length. Each used frame has one slot. So that each slot
/// keeps its time, a missing frame and a frame that is not used (incomplete) have one too: there
/// the used frame before it is held. Before the first used frame nothing can be held, so there
/// are no such slots: slot 0 has the time of the first used frame.
class GapFiller {
  public:
    /// What lies between a frame and the one before it.
    struct Gap {
        std::uint64_t lost = 0;  ///< missing frames
        /// Held slots: `lost`, at most 2^40 so that sums do not overflow, and 1 for the frame
        /// itself if it is not used.
        std::uint64_t held = 0;
    };

    /// The gap that ends with the next frame. As many frames are missing as its record says, or
    /// as the ids say if these are more: they include frames that a damaged file has lost.
    [[nodiscard]] Gap next(const FrameRecord& record, bool is_used = true);

  private:
    std::optional<std::uint64_t> last_id_;  ///< of the frame before, used or not
    bool has_used_ = false;                 ///< a frame
};

}  // namespace stipple
