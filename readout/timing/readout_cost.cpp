#include "readout/timing/readout_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>

#include "core/error.h"

namespace stipple {
namespace {

constexpr char kWhere[] = "readout timing";

/// \throws InputError if no row can be read whatever is dropped.
void check_droppable(const ScanCosts& scans, std::int64_t budget) {
    const ReadoutTiming& timing = scans.timing();
    const std::int64_t slots = scans.longest_deadline_slots();
    if (slots == 0 && !timing.exposes_while_reading)
        throw InputError(kWhere,
                         "this sensor cannot expose while it reads, and the schedule leaves it no "
                         "slot to read in; take the policy stretch, or a schedule with slots in "
                         "which all pixels are closed");
    const auto check = [&](std::int64_t clocks, std::int64_t available, const char* what) {
        if (clocks > available)
            throw InputError(kWhere, fmt::format("{} takes {} clocks, its deadline is {}, and "
                                                 "dropping rows does not help; raise slot_us",
                                                 what, clocks, available));
    };
    check(timing.code_load_clocks, budget, "the load of the exposure code");
    check(
        timing.overhead_clocks + timing.overhead_rows * full_row_clocks(timing, scans.shape().cols),
        std::max(slots, std::int64_t{1}) * budget, "the overhead before the rows");
}

}  // namespace

ReadoutCost::ReadoutCost(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                         FrameShape shape, SlotBudget budget)
    : timing_(timing), budget_(budget) {
    scans_.emplace(timing, schedule, shape);
    if (budget.clocks == 0) budget_.policy = OverrunPolicy::kStretch;
    if (budget_.policy == OverrunPolicy::kDrop) check_droppable(*scans_, budget.clocks);
}

SlotTimes ReadoutCost::times(std::int64_t slot, const SlotCost& cost) {
    SlotTimes times = scans_->times(slot + steady_, cost.scan_begin);
    std::erase_if(times.rows, [&](const RowTimes& row) { return row.load.row >= cost.end_row; });
    times.end = times.rows.empty() ? cost.scan_begin : times.rows.back().frame_end;
    return times;
}

bool ReadoutCost::meets_deadlines(const ScanCost& scan) const {
    return std::ranges::all_of(scan.deadlines, [&](const ScanDeadline& deadline) {
        return slot_.scan_begin + deadline.end <= slot_.begin + deadline.slots * budget_.clocks;
    });
}

ReadoutCost::Cut ReadoutCost::cut(std::int64_t delay) {
    const SlotTimes times = scans_->times(slots_, delay);
    const auto is_late = [&](const RowTimes& row) {
        return row.load.row >= 0 &&
               row.frame_end > scans_->deadline_slots(slots_, row.load.row) * budget_.clocks;
    };
    const auto first_late = std::ranges::find_if(times.rows, is_late);
    Cut left{.delay = delay, .counts = {}, .end_row = first_late->load.row};
    if (first_late != times.rows.begin() && std::prev(first_late)->load.row >= 0)
        for (const RowTimes& row : std::span(times.rows.begin(), first_late)) {
            scans_->count(row, left.counts);
            left.counts.readout_clocks = row.frame_end - delay;
        }
    for (const RowTimes& row : std::span(first_late, times.rows.end()))
        left.counts.dropped_samples +=
            static_cast<std::uint64_t>(shape().planes) * static_cast<std::uint64_t>(row.load.due);
    left.counts.energy_pj += timing().code_bit_pj * static_cast<double>(shape().pixels());
    return left;
}

void ReadoutCost::drop_late_rows() {
    const std::int64_t delay = slot_.scan_begin - slot_.begin;
    const bool is_early = slots_ < first_steady_slot();
    Cut& known = cuts_[is_early ? -1 : slots_ % schedule().period_slots()];
    if (is_early || known.delay != delay) known = cut(delay);
    slot_.counts = known.counts;
    slot_.end_row = known.end_row;
    slot_.overrun = true;
}

std::int64_t ReadoutCost::least_clocks() const {
    return std::max({budget_.clocks, timing().code_load_clocks, std::int64_t{1}});
}

std::int64_t ReadoutCost::end_of_slot(const ScanCost& scan) {
    const std::int64_t clocks = least_clocks();
    if (!timing().exposes_while_reading)
        return clocks + (scans_->exposes(slots_ + steady_ + 1) ? std::max(slot_.begin, scan_end_)
                                                               : slot_.begin);
    if (budget_.policy == OverrunPolicy::kStretch)
        for (const ScanDeadline& deadline : scan.deadlines) {
            std::int64_t& not_before = due_[slots_ + deadline.slots];
            not_before = std::max(not_before, slot_.scan_begin + deadline.end);
        }
    std::int64_t end = slot_.begin + clocks;
    if (const auto due = due_.find(slots_ + 1); due != due_.end()) {
        end = std::max(end, due->second);
        due_.erase(due);
    }
    return end;
}

const SlotCost& ReadoutCost::step() {
    const ScanCost& scan = scans_->of(slots_ + steady_);
    slot_ = {.counts = scan.counts,
             .begin = end_,
             .scan_begin = std::max(end_, scan_end_),
             .settle_clocks = scan.settle_clocks,
             .end_row = scans_->shape().rows,
             .limit = scan.limit};
    if (budget_.policy == OverrunPolicy::kDrop && !meets_deadlines(scan)) drop_late_rows();
    scan_end_ = slot_.scan_begin + slot_.counts.readout_clocks;
    end_ = end_of_slot(scan);
    slot_.clocks = end_ - slot_.begin;
    if (budget_.clocks > 0 && slot_.clocks > budget_.clocks) slot_.overrun = true;
    ++slots_;
    return slot_;
}

void ReadoutCost::begin_at(std::int64_t slot) {
    while (slots_ < slot) step();
    for (auto& due : due_) due.second -= end_;
    scan_end_ -= end_;
    end_ = 0;
}

SlotCost ReadoutCost::before_switch(const ExposureSchedule& next, std::int64_t known) const {
    std::int64_t end = end_;
    if (!timing_.exposes_while_reading) {
        known = std::max(known, slot_.begin);
        end = slot_.begin + least_clocks();
        if (scans_->exposes(slots_ + steady_))
            end += std::max(std::min(known, scan_end_) - slot_.begin, std::int64_t{0});
        if (ScanCosts(timing_, next, shape()).exposes(slots_))
            end += std::max(scan_end_ - known, std::int64_t{0});
    }
    SlotCost slot = slot_;
    slot.clocks = std::max(end, scan_end_) - slot.begin;
    slot.overrun = budget_.clocks > 0 && slot.clocks > budget_.clocks;
    return slot;
}

void ReadoutCost::switch_to(const ExposureSchedule& next, std::int64_t known) {
    const SlotCost slot = before_switch(next, known);
    overruns_ += (slot.overrun ? 1 : 0) - (slot_.overrun ? 1 : 0);
    slot_ = slot;
    end_ = slot_.begin + slot_.clocks;
    due_.clear();
    scans_.emplace(timing_, next, shape());
    steady_ = std::int64_t{kMaxExposureSlots} * next.period_slots();
}

const SlotCost& ReadoutCost::add_next() {
    step();
    overruns_ += slot_.overrun ? 1 : 0;
    totals_ += slot_.counts;
    return slot_;
}

std::int64_t slot_clocks(const ReadoutTiming& timing, double slot_us) {
    const double clocks = std::floor(slot_us * static_cast<double>(timing.clock_hz) / 1e6);
    if (clocks < 1)
        throw InputError(kWhere, fmt::format("a slot of {} us is shorter than a clock of {} Hz; "
                                             "raise slot_us",
                                             slot_us, timing.clock_hz));
    if (clocks > static_cast<double>(kMaxReadoutClocks))
        throw InputError(kWhere, fmt::format("a slot of {} us has more than {} clocks of {} Hz; "
                                             "lower slot_us",
                                             slot_us, kMaxReadoutClocks, timing.clock_hz));
    return static_cast<std::int64_t>(clocks);
}

}  // namespace stipple
