#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"
#include "readout/timing/slot_readout.h"

namespace stipple {

/// The part of a readout that takes most of its time.
enum class ReadoutLimit : std::uint8_t { kAdc, kLink, kRowOverhead, kCodeLoad };

/// As a word: "adc", "link", "row_overhead", "code_load".
[[nodiscard]] std::string_view name_of(ReadoutLimit limit);

/// Counts of a readout. The planes of a pixel have separate circuits that work in parallel, so they
/// multiply samples, conversions, bits and energy, but not clocks.
struct ReadoutCounts {
    std::uint64_t samples = 0;          ///< in the stream
    std::uint64_t dropped_samples = 0;  ///< due, but did not meet their deadline
    std::uint64_t transferred = 0;  ///< values on the link, those of dark rows and groups included
    std::uint64_t bits = 0;         ///< on the link
    std::uint64_t conversions = 0;  ///< of all ADCs
    std::int64_t rows = 0;          ///< selected, dark ones included
    std::int64_t readout_clocks = 0;  ///< from the beginning of a scan to its end
    std::int64_t convert_clocks = 0;  ///< while columns are selected and converted
    std::int64_t link_clocks = 0;     ///< while the link transfers
    double energy_pj = 0;

    ReadoutCounts& operator+=(const ReadoutCounts& more);
};

/// The rows of a scan that must be read within `slots`.
struct ScanDeadline {
    int slots = 0;         ///< from the end of the exposures on
    std::int64_t end = 0;  ///< clocks from the beginning of the scan until the last row is read
};

/// The scan that reads the due rows of a slot, by itself: what it takes, and by when.
struct ScanCost {
    ReadoutCounts counts;
    int settle_clocks = 0;  ///< of its rows
    ReadoutLimit limit = ReadoutLimit::kLink;
    std::vector<ScanDeadline> deadlines;  ///< slots and ends rise; none: nothing is read
};

/// The scans of a schedule. Depend on the schedule, not on the light nor on the length of slots.
///
/// **Deadline.** A sensor that exposes while it reads keeps each sample in its pixel until the row
/// is due again: `RowLoads::due_again_slots`. A sensor that cannot must have read all rows before
/// the next slot in which any pixel is open: 0 slots if that follows at once.
class ScanCosts {
  public:
    /// `shape`: the window that is read. `schedule` must outlive this.
    /// \throws InputError as `check_window`.
    ScanCosts(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape);
    ScanCosts(const ScanCosts&) = delete;
    ScanCosts& operator=(const ScanCosts&) = delete;

    /// The scan at the end of `slot`. Steady slots of the same phase are equal and computed once.
    [[nodiscard]] const ScanCost& of(std::int64_t slot);
    /// Times of its rows if it begins at clock `begin`.
    [[nodiscard]] SlotTimes times(std::int64_t slot, std::int64_t begin);
    /// Slots that row `row` may wait after the end of `slot`, in which it is due.
    [[nodiscard]] int deadline_slots(std::int64_t slot, int row) const;
    /// The longest time that a row may wait, in slots; 0 if nothing is read.
    [[nodiscard]] int longest_deadline_slots() const;
    /// Adds one row to the counts.
    void count(const RowTimes& row, ReadoutCounts& counts) const;
    /// True if some pixel is open in `slot`. Precondition: the sensor cannot expose while it reads.
    [[nodiscard]] bool exposes(std::int64_t slot) const {
        return exposes_[static_cast<std::size_t>(slot % schedule_.period_slots())];
    }

    /// The timing, with the code load of the window instead of the array.
    [[nodiscard]] const ReadoutTiming& timing() const { return timing_; }
    [[nodiscard]] const ExposureSchedule& schedule() const { return schedule_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] RowLoads& row_loads() { return row_loads_; }
    /// Earlier slots lack exposures that would have begun before slot 0.
    [[nodiscard]] std::int64_t first_steady_slot() const { return first_steady_slot_; }

  private:
    [[nodiscard]] ScanCost compute(std::int64_t slot);
    [[nodiscard]] int closed_slots_after(std::int64_t slot) const;

    ReadoutTiming timing_;
    const ExposureSchedule& schedule_;
    FrameShape shape_;
    RowLoads row_loads_;
    std::int64_t first_steady_slot_ = 0;
    std::vector<bool> exposes_;       ///< by phase
    std::vector<ScanCost> by_phase_;  ///< of steady slots
    std::vector<bool> known_;         ///< by phase
    ScanCost early_;                  ///< of the last slot before those
    std::vector<RowLoad> loads_;
};

}  // namespace stipple
