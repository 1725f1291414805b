#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "core/schedule_parts.h"

namespace stipple {

/// The sequencer of the chip: for each slot, the pixels that collect light and the pixels that are
/// read at its end, row by row in scan order. Times within the slot are in slot_readout.h.
class Sequencer {
  public:
    /// `schedule` must outlive the sequencer. Precondition: it needs at most two charge stores.
    Sequencer(const ExposureSchedule& schedule, FrameShape shape);

    /// From `slot` on it follows another schedule, which must outlive the sequencer; exposures
    /// under way go on (schedule_parts.h). Precondition: neither schedule has interleaved
    /// exposures; slots of switches rise from 1 on.
    void switch_to(const ExposureSchedule& schedule, std::int64_t slot);

    /// True if all pixels collect light in this slot, in exposures that began in slot 0 or later.
    [[nodiscard]] bool all_open(std::int64_t slot) const noexcept;

    /// `open[col]` = 1 for each pixel of `row` that collects light in such an exposure, 2 if the
    /// light goes to its second charge store (interleaved schedules only), 0 for the others.
    /// Precondition: open.size() == columns of the array.
    void list_open(std::int64_t slot, int row, std::span<std::uint8_t> open) const noexcept;

    /// Appends row * cols + col of each pixel of `row` that is read at the end of `slot`, by
    /// column.
    void append_due(std::int64_t slot, int row, std::vector<std::uint32_t>& pixels) const;

    /// Appends the charge store, 0 or 1, of each pixel that `append_due` appends.
    void append_stores(std::int64_t slot, int row, std::vector<std::uint8_t>& stores) const;

    /// Appends the number of slots in which each of these pixels collected light.
    void append_open_slots(std::int64_t slot, int row, std::vector<std::uint16_t>& slots) const;

  private:
    [[nodiscard]] const ExposureSchedule& schedule() const noexcept {
        return *parts_.back().schedule;
    }

    std::vector<SchedulePart> parts_;
    int cols_;
    bool gapless_;
};

}  // namespace stipple
