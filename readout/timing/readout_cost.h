#pragma once

#include <cstdint>
#include <map>
#include <optional>

#include "core/exposure_schedule.h"
#include "core/geometry.h"
#include "readout/timing/overrun_policy.h"
#include "readout/timing/readout_timing.h"
#include "readout/timing/row_loads.h"
#include "readout/timing/scan_cost.h"
#include "readout/timing/slot_readout.h"

namespace stipple {

/// Duration of a slot.
struct SlotBudget {
    std::int64_t clocks = 0;  ///< 0: as short as the readout allows
    OverrunPolicy policy = OverrunPolicy::kStretch;
};

/// A slot and the scan of the samples that are ready when it begins. In clocks since the first slot
/// of the totals.
struct SlotCost {
    ReadoutCounts counts;
    std::int64_t begin = 0;       ///< of the slot
    std::int64_t scan_begin = 0;  ///< later if the scan before has not ended
    std::int64_t clocks = 0;      ///< of the slot: the budget, or longer by deadline or code load
    int settle_clocks = 0;        ///< of its rows
    int end_row = 0;              ///< rows from here on are dropped; rows of the window: none
    bool overrun = false;         ///< stretched, or rows of its scan are dropped
    ReadoutLimit limit = ReadoutLimit::kLink;  ///< of its scan
};

/// Slots and scans on one time line, slot by slot, and their totals. Depends on the schedule, not
/// on the light.
///
/// The chip has one scan. It reads the due rows of a slot from the end of their exposures on, or as
/// soon as the scan before has ended. If a row would miss its deadline (`ScanCosts`), then with
/// kStretch the slot at whose end the row is due again lasts until it is read; with kDrop this row
/// and the later ones of its scan are not read.
class ReadoutCost {
  public:
    /// `shape`: the window that is read. `schedule` must outlive this.
    /// \throws InputError as `check_window`, or if with kDrop overhead and code load do not even
    /// fit the longest deadline.
    ReadoutCost(const ReadoutTiming& timing, const ExposureSchedule& schedule, FrameShape shape,
                SlotBudget budget);

    /// Times of the rows that the scan of a slot reads. `cost`: that slot.
    [[nodiscard]] SlotTimes times(std::int64_t slot, const SlotCost& cost);

    /// From slot `slots()` on, not the first one, the chip follows `next`, which must outlive this.
    /// The slot before lasts until no row waits, so that the rows of a scan are those of one
    /// schedule, and all pixels that are read from here on are due (docs/stream_format.md, kind 4).
    /// `known`: the first clock in which the chip knows it; counts for a chip that cannot expose
    /// while it reads. Precondition: kStretch, and a slot was added.
    void switch_to(const ExposureSchedule& next, std::int64_t known = 0);
    /// The slot before such a switch.
    [[nodiscard]] SlotCost before_switch(const ExposureSchedule& next,
                                         std::int64_t known = 0) const;

    /// The totals begin with this slot; what earlier slots leave to read is known. Precondition:
    /// nothing was added yet.
    void begin_at(std::int64_t slot);
    /// Adds slot `slots()` to the totals and returns it.
    const SlotCost& add_next();
    [[nodiscard]] std::int64_t slots() const { return slots_; }
    [[nodiscard]] std::int64_t overruns() const { return overruns_; }
    [[nodiscard]] std::int64_t clocks() const { return end_; }
    [[nodiscard]] const ReadoutCounts& totals() const { return totals_; }

    [[nodiscard]] const ReadoutTiming& timing() const { return scans_->timing(); }
    [[nodiscard]] const ExposureSchedule& schedule() const { return scans_->schedule(); }
    [[nodiscard]] FrameShape shape() const { return scans_->shape(); }
    [[nodiscard]] SlotBudget budget() const { return budget_; }
    [[nodiscard]] RowLoads& row_loads() { return scans_->row_loads(); }
    [[nodiscard]] std::int64_t first_steady_slot() const { return scans_->first_steady_slot(); }

  private:
    /// What is left of a scan that begins late.
    struct Cut {
        std::int64_t delay = -1;  ///< of its scan
        ReadoutCounts counts;
        int end_row = 0;
    };
    const SlotCost& step();
    [[nodiscard]] std::int64_t least_clocks() const;  ///< of a slot
    void drop_late_rows();
    [[nodiscard]] Cut cut(std::int64_t delay);
    [[nodiscard]] bool meets_deadlines(const ScanCost& scan) const;
    [[nodiscard]] std::int64_t end_of_slot(const ScanCost& scan);

    ReadoutTiming timing_;  ///< of the array
    std::optional<ScanCosts> scans_;
    std::int64_t steady_ = 0;  ///< to the slots of `scans_`, of which none is early after a switch
    SlotBudget budget_;
    SlotCost slot_;
    std::int64_t end_ = 0;                      ///< of `slot_`
    std::int64_t scan_end_ = 0;                 ///< of the last scan
    std::map<std::int64_t, std::int64_t> due_;  ///< slots that end no earlier than a clock
    std::map<std::int64_t, Cut> cuts_;          ///< the last one of each phase; -1: of early slots

    std::int64_t slots_ = 0;
    std::int64_t overruns_ = 0;
    ReadoutCounts totals_;
};

/// Whole clocks in a slot of `slot_us`.
/// \throws InputError if there is none or more than `kMaxReadoutClocks`.
[[nodiscard]] std::int64_t slot_clocks(const ReadoutTiming& timing, double slot_us);

}  // namespace stipple
