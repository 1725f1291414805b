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

/// What a chip does when the readout of a slot takes longer than the slot.
enum class OverrunPolicy : std::uint8_t {
    kStretch,  ///< the slot lasts as long as its readout; the light stays that of a slot
    kDrop      ///< rows that do not fit are reset without being read
};

/// What takes most of the time of a readout.
enum class ReadoutLimit : std::uint8_t { kAdc, kLink, kRowOverhead, kCodeLoad };

/// As a word: "adc", "link", "row_overhead", "code_load".
[[nodiscard]] std::string_view name_of(ReadoutLimit limit);

/// The time that a readout gives its slot.
struct SlotBudget {
    std::int64_t clocks = 0;  ///< 0: as long as it takes
    OverrunPolicy policy = OverrunPolicy::kStretch;
};

/// What a readout has done. The planes of a pixel are read side by side, each by circuits of its
/// own, so they multiply samples, conversions, bits and energy, but not clocks.
struct ReadoutCounts {
    std::uint64_t samples = 0;          ///< that leave in the stream
    std::uint64_t dropped_samples = 0;  ///< that were due and did not fit
    std::uint64_t transferred = 0;      ///< values over the link: those of dark rows and groups too
    std::uint64_t bits = 0;             ///< over the link
    std::uint64_t conversions = 0;      ///< of all ADCs
    std::int64_t rows = 0;              ///< selected, dark ones included
    std::int64_t readout_clocks = 0;    ///< from the beginning of a slot to the end of its readout
    std::int64_t convert_clocks = 0;    ///< in which the columns are selected and converted
    std::int64_t link_clocks = 0;       ///< in which the link transfers
    double energy_pj = 0;

    ReadoutCounts& operator+=(const ReadoutCounts& more);
};

/// A slot, accounted for.
struct SlotAccount {
    ReadoutCounts counts;
    std::int64_t clocks = 0;  ///< of the slot: the budget, or what readout and code load take
    int settle_clocks = 0;    ///< that its rows take
    int end_row = 0;          ///< rows from here on are dropped; those of the window: none
    bool overrun = false;     ///< the budget was too short
    ReadoutLimit limit = ReadoutLimit::kLink;
};

/// Keeps account of the readout, slot by slot. It depends on the schedule, not on the light.
class ReadoutAccount {
  public:
    /// What is read of the array, and how fast. `schedule` must outlive this.
    /// \throws InputError as `check_window`, or if with kDrop not even overhead and code load fit
    /// the budget.
    ReadoutAccount(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape,
                   SlotBudget budget);

    /// What `slot` costs. Slots of the same phase are alike once all exposures are under way, and
    /// then cost no time to account for.
    [[nodiscard]] const SlotAccount& of(std::int64_t slot);
    /// When its rows are read, from `begin` on, without those that are dropped.
    [[nodiscard]] SlotTimes times(std::int64_t slot, std::int64_t begin);

    /// Adds slot `slots()` to the totals and returns it.
    const SlotAccount& add_next();
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    [[nodiscard]] std::int64_t overruns() const { return overruns_; }
    [[nodiscard]] std::int64_t clocks() const { return clocks_; }
    [[nodiscard]] const ReadoutCounts& totals() const { return totals_; }

    /// With the load of the code of these rows in place of the array's.
    [[nodiscard]] const ReadoutTiming& timing() const { return timing_; }
    [[nodiscard]] const ExposureSchedule& schedule() const { return schedule_; }
    [[nodiscard]] FrameShape shape() const { return shape_; }
    [[nodiscard]] SlotBudget budget() const { return budget_; }
    [[nodiscard]] RowLoads& row_loads() { return row_loads_; }
    /// Slots before this one miss exposures that would have begun before slot 0.
    [[nodiscard]] std::int64_t first_steady_slot() const { return first_steady_slot_; }

  private:
    [[nodiscard]] SlotAccount account(std::int64_t slot);
    [[nodiscard]] std::size_t rows_that_fit(const SlotTimes& times) const;
    void count(const RowTimes& row, ReadoutCounts& counts) const;

    ReadoutTiming timing_;
    const ExposureSchedule& schedule_;
    FrameShape shape_;
    SlotBudget budget_;
    RowLoads row_loads_;
    std::int64_t first_steady_slot_ = 0;
    std::vector<SlotAccount> by_phase_;  ///< of steady slots; `clocks` 0: not yet known
    SlotAccount early_;                  ///< of the last slot before those
    std::vector<RowLoad> loads_;

    std::int64_t slots_ = 0;
    std::int64_t overruns_ = 0;
    std::int64_t clocks_ = 0;
    ReadoutCounts totals_;
};

/// Clocks of a slot of `slot_us`, the last one that has begun left out.
/// \throws InputError if there is none or more than `kMaxReadoutClocks`.
[[nodiscard]] std::int64_t slot_clocks(const ReadoutTiming& timing, double slot_us);

/// Memory of the sequencer that steps through the schedule, in bits: for each slot of the period
/// and pixel of the tile one, with gaps two, with two charge stores three
/// (docs/sequencer_program.md).
[[nodiscard]] std::uint64_t schedule_memory_bits(const ExposureSchedule& schedule);

}  // namespace stipple
