#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/overrun_policy.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"
#include "readout/timing/slot_readout.h"

namespace stipple {

/// The part of a readout that takes most of its time.
enum class ReadoutLimit : std::uint8_t { kAdc, kLink, kRowOverhead, kCodeLoad };

/// As a word: "adc", "link", "row_overhead", "code_load".
[[nodiscard]] std::string_view name_of(ReadoutLimit limit);

/// Duration of a slot.
struct SlotBudget {
    std::int64_t clocks = 0;  ///< 0: as long as the readout
    OverrunPolicy policy = OverrunPolicy::kStretch;
};

/// Counts of a readout. The planes of a pixel have separate circuits that work in parallel, so they
/// multiply samples, conversions, bits and energy, but not clocks.
struct ReadoutCounts {
    std::uint64_t samples = 0;          ///< in the stream
    std::uint64_t dropped_samples = 0;  ///< due, but did not fit
    std::uint64_t transferred = 0;  ///< values on the link, those of dark rows and groups included
    std::uint64_t bits = 0;         ///< on the link
    std::uint64_t conversions = 0;  ///< of all ADCs
    std::int64_t rows = 0;          ///< selected, dark ones included
    std::int64_t readout_clocks = 0;  ///< from the beginning of a slot to the end of its readout
    std::int64_t convert_clocks = 0;  ///< while columns are selected and converted
    std::int64_t link_clocks = 0;     ///< while the link transfers
    double energy_pj = 0;

    ReadoutCounts& operator+=(const ReadoutCounts& more);
};

/// Cost of a slot.
struct SlotCost {
    ReadoutCounts counts;
    std::int64_t clocks = 0;  ///< of the slot: the budget, or longer by readout or code load
    int settle_clocks = 0;    ///< of its rows
    int end_row = 0;          ///< rows from here on are dropped; rows of the window: none
    bool overrun = false;     ///< the budget was too short
    ReadoutLimit limit = ReadoutLimit::kLink;
};

/// Cost of the readout slot by slot, and its totals. Depends on the schedule, not on the light.
class ReadoutCost {
  public:
    /// `shape`: the window that is read. `schedule` must outlive this.
    /// \throws InputError as `check_window`, or if with kDrop not even overhead and code load fit
    /// the budget.
    ReadoutCost(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape,
                SlotBudget budget);

    /// Cost of `slot`. Steady slots of the same phase are equal and computed once.
    [[nodiscard]] const SlotCost& of(std::int64_t slot);
    /// Times of its rows from `begin` on, without dropped rows.
    [[nodiscard]] SlotTimes times(std::int64_t slot, std::int64_t begin);

    /// The totals begin with this slot.
    void begin_at(std::int64_t slot) { slots_ = slot; }
    /// Adds slot `slots()` to the totals and returns it.
    const SlotCost& add_next();
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    [[nodiscard]] std::int64_t overruns() const { return overruns_; }
    [[nodiscard]] std::int64_t clocks() const { return clocks_; }
    [[nodiscard]] const ReadoutCounts& totals() const { return totals_; }

    /// The timing, with the code load of the window instead of the array.
    [[nodiscard]] const ReadoutTiming& timing() const { return timing_; }
    [[nodiscard]] const ExposureSchedule& schedule() const { return schedule_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] SlotBudget budget() const { return budget_; }
    [[nodiscard]] RowLoads& row_loads() { return row_loads_; }
    /// Earlier slots lack exposures that would have begun before slot 0.
    [[nodiscard]] std::int64_t first_steady_slot() const { return first_steady_slot_; }

  private:
    [[nodiscard]] SlotCost compute(std::int64_t slot);
    [[nodiscard]] std::size_t rows_that_fit(const SlotTimes& times) const;
    void count(const RowTimes& row, ReadoutCounts& counts) const;

    ReadoutTiming timing_;
    const ExposureSchedule& schedule_;
    FrameShape shape_;
    SlotBudget budget_;
    RowLoads row_loads_;
    std::int64_t first_steady_slot_ = 0;
    std::vector<SlotCost> by_phase_;  ///< of steady slots; `clocks` 0: not yet known
    SlotCost early_;                  ///< of the last slot before those
    std::vector<RowLoad> loads_;

    std::int64_t slots_ = 0;
    std::int64_t overruns_ = 0;
    std::int64_t clocks_ = 0;
    ReadoutCounts totals_;
};

/// Whole clocks in a slot of `slot_us`.
/// \throws InputError if there is none or more than `kMaxReadoutClocks`.
[[nodiscard]] std::int64_t slot_clocks(const ReadoutTiming& timing, double slot_us);

}  // namespace stipple
