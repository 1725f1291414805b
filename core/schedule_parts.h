#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"

namespace stipple {

/// A schedule that a sensor follows from a slot on, up to the first slot of the next part. At this
/// switch nothing is reset: an exposure under way goes on, open as the new schedule says, until
/// that first reads its pixel (docs/stream_format.md, "Switch"). Precondition of all that follows:
/// parts come by slot, the first one begins in slot 0, and no exposures are interleaved.
struct SchedulePart {
    const ExposureSchedule* schedule = nullptr;  ///< outlives this
    std::int64_t first_slot = 0;
    bool follows = true;  ///< the part before it; false if there are others between the two
};

/// The part that holds in `slot`. Precondition: slot >= 0.
[[nodiscard]] std::size_t part_at(std::span<const SchedulePart> parts, std::int64_t slot);

/// A slot of the same due pixels, for visit_due_pixels: after a switch no exposure has begun before
/// slot 0.
[[nodiscard]] inline std::int64_t readout_slot(const SchedulePart& part, std::int64_t slot) {
    const std::int64_t steady = std::int64_t{kMaxExposureSlots} * part.schedule->period_slots();
    return part.first_slot == 0 ? slot : slot + steady;
}

struct PixelSlot {
    std::int64_t slot = 0;
    int row = 0;  ///< of the array
    int col = 0;
};

/// The open slots of the exposure that is read at the end of a slot: bit i is slot `first_slot +
/// i`, bit 0 is set. Nothing if it began before an unknown part. Precondition: the pixel is due
/// there, and no exposure has more than 64 slots (UnreadSlots).
struct ReadExposure {
    std::int64_t first_slot = 0;
    std::uint64_t open_slots = 1;
};
[[nodiscard]] std::optional<ReadExposure> read_exposure(std::span<const SchedulePart> parts,
                                                        const PixelSlot& at);

/// Of each pixel of an array the open slots that are not read before a switch: what limits the next
/// schedule.
class UnreadSlots {
  public:
    explicit UnreadSlots(FrameShape shape) : shape_(shape), unread_(shape.pixels()) {}

    /// Goes on to the last of `parts`, of which those before it were passed by earlier calls.
    void pass(std::span<const SchedulePart> parts);

    struct Longest {
        PixelSlot read_at;
        std::int64_t slots = 0;  ///< from 64 + the slots after the switch on: that or more
    };
    /// The longest of the exposures that are read first after the switch to the last part; slots 0
    /// without any. A stream has at most 64.
    [[nodiscard]] Longest longest(const SchedulePart& last) const;

  private:
    FrameShape shape_;
    /// Bit i of a pixel is the slot i + 1 before the switch; bit 63 stands for earlier ones, too.
    std::vector<std::uint64_t> unread_;
};

}  // namespace stipple
