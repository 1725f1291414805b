#include "readout/timing/readout_cost.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"

namespace stipple {
namespace {

constexpr char kWhere[] = "readout timing";

std::uint64_t wide(int value) {
    return static_cast<std::uint64_t>(value);
}

/// Clocks of a readout that its ADCs or its link take; the rest is overhead.
struct TimeShares {
    std::int64_t adc = 0;
    std::int64_t link = 0;
};

/// Rows that are converted and transferred in turns: each step takes its own time.
TimeShares shares_in_turns(const SlotTimes& times) {
    TimeShares shares;
    for (const RowTimes& row : times.rows) {
        shares.adc += row.convert_end - row.convert;
        shares.link += row.transfer_end - row.transfer;
    }
    return shares;
}

/// Rows of which one is transferred while the next one is converted: the longer step takes the
/// time of both. A transfer that begins later than right after the one before was held up.
TimeShares shares_overlapped(const ReadoutTiming& timing, const SlotTimes& times) {
    TimeShares shares;
    const auto add = [&](const RowTimes& row, bool held_up, std::int64_t converted) {
        if (held_up)
            shares.adc += converted;
        else if (timing.row_timing != RowTiming::kFullWidth)
            shares.link += row.transfer_end - row.transfer;
    };
    for (std::size_t i = 0; i + 1 < times.rows.size(); ++i) {
        const RowTimes& row = times.rows[i];
        const RowTimes& next = times.rows[i + 1];
        add(row, next.transfer > row.transfer_end + timing.blanking_clocks,
            next.convert_end - next.convert);
    }
    const RowTimes& last = times.rows.back();
    add(last, last.end_if_last > last.transfer_end + timing.blanking_clocks,
        last.convert_end - last.convert);
    return shares;
}

ReadoutLimit limit_of(const ReadoutTiming& timing, const SlotTimes& times) {
    if (times.rows.empty()) return ReadoutLimit::kRowOverhead;
    const bool in_turns = timing.row_timing == RowTiming::kSequential;
    const auto [adc, link] = in_turns ? shares_in_turns(times) : shares_overlapped(timing, times);
    const std::int64_t overhead = times.end - times.begin - adc - link;
    const std::int64_t longest = std::max({adc, link, overhead});
    if (longest == link) return ReadoutLimit::kLink;
    return longest == adc ? ReadoutLimit::kAdc : ReadoutLimit::kRowOverhead;
}

}  // namespace

std::string_view name_of(ReadoutLimit limit) {
    constexpr std::array<std::string_view, 4> kNames{"adc", "link", "row_overhead", "code_load"};
    return kNames.at(static_cast<std::size_t>(limit));
}

ReadoutCounts& ReadoutCounts::operator+=(const ReadoutCounts& more) {
    samples += more.samples;
    dropped_samples += more.dropped_samples;
    transferred += more.transferred;
    bits += more.bits;
    conversions += more.conversions;
    rows += more.rows;
    readout_clocks += more.readout_clocks;
    convert_clocks += more.convert_clocks;
    link_clocks += more.link_clocks;
    energy_pj += more.energy_pj;
    return *this;
}

ReadoutCost::ReadoutCost(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                         FrameShape shape, SlotBudget budget)
    : timing_(timing),
      schedule_(schedule),
      shape_(shape),
      budget_(budget),
      row_loads_(timing_, schedule, shape),
      first_steady_slot_(std::max(schedule.longest_span_slots(), 1) - 1),
      by_phase_(static_cast<std::size_t>(schedule.period_slots())) {
    timing_.code_load_clocks = code_load_clocks(timing, shape.rows);
    if (budget.policy != OverrunPolicy::kDrop || budget.clocks == 0) return;
    const auto check = [&](std::int64_t clocks, const char* what) {
        if (clocks > budget.clocks)
            throw InputError(kWhere, fmt::format("{} takes {} clocks of a slot's {}, and dropping "
                                                 "rows does not help; raise slot_us",
                                                 what, clocks, budget.clocks));
    };
    check(timing_.code_load_clocks, "the load of the exposure code");
    check(timing.overhead_clocks + timing.overhead_rows * full_row_clocks(timing, shape.cols),
          "the overhead before the rows");
}

const SlotCost& ReadoutCost::of(std::int64_t slot) {
    if (slot < first_steady_slot_) return early_ = compute(slot);
    SlotCost& known = by_phase_[static_cast<std::size_t>(slot % schedule_.period_slots())];
    if (known.clocks == 0) known = compute(slot);
    return known;
}

std::size_t ReadoutCost::rows_that_fit(const SlotTimes& times) const {
    std::size_t fit = times.rows.size();
    if (budget_.clocks == 0 || budget_.policy != OverrunPolicy::kDrop) return fit;
    while (fit > 0 && times.rows[fit - 1].end_if_last - times.begin > budget_.clocks) --fit;
    return fit;
}

void ReadoutCost::count(const RowTimes& row, ReadoutCounts& counts) const {
    const std::uint64_t planes = wide(shape_.planes);
    const std::uint64_t transferred = planes * wide(row.load.columns);
    const std::uint64_t bits = transferred * wide(timing_.bits_per_sample);
    const std::uint64_t conversions = timing_.adc_skip ? transferred : planes * wide(shape_.cols);
    counts.samples += planes * wide(row.load.due);
    counts.transferred += transferred;
    counts.bits += bits;
    counts.conversions += conversions;
    ++counts.rows;
    counts.convert_clocks += row.convert_end - row.select;
    counts.link_clocks += row.transfer_end - row.transfer;
    counts.energy_pj += timing_.row_select_pj +
                        conversion_energy_pj(timing_) * static_cast<double>(conversions) +
                        timing_.link_bit_pj * static_cast<double>(bits);
}

SlotTimes ReadoutCost::times(std::int64_t slot, std::int64_t begin) {
    row_loads_.list(slot, loads_);
    SlotTimes times = read_slot(timing_, shape_.cols, loads_, begin);
    const std::size_t fit = rows_that_fit(times);
    if (fit < times.rows.size()) {
        times.rows.resize(fit);
        times.end = fit > 0 ? times.rows.back().end_if_last : begin;
    }
    return times;
}

SlotCost ReadoutCost::compute(std::int64_t slot) {
    const SlotTimes times = this->times(slot, 0);  // fills loads_ with all rows that are due
    SlotCost cost;
    ReadoutCounts& counts = cost.counts;
    for (const RowTimes& row : times.rows) count(row, counts);
    const std::size_t read = times.rows.size();
    for (const RowLoad& load : std::span(loads_).subspan(read))
        counts.dropped_samples += wide(shape_.planes) * wide(load.due);
    cost.end_row = read < loads_.size() ? std::max(loads_[read].row, 0) : shape_.rows;
    cost.settle_clocks = times.settle;
    counts.readout_clocks = times.end;
    counts.energy_pj += timing_.code_bit_pj * static_cast<double>(shape_.pixels());
    const std::int64_t needed = std::max(times.end, timing_.code_load_clocks);
    cost.overrun = read < loads_.size() || (budget_.clocks > 0 && needed > budget_.clocks);
    cost.clocks = std::max({needed, budget_.clocks, std::int64_t{1}});
    cost.limit =
        timing_.code_load_clocks > times.end ? ReadoutLimit::kCodeLoad : limit_of(timing_, times);
    return cost;
}

const SlotCost& ReadoutCost::add_next() {
    const SlotCost& slot = of(slots_++);
    overruns_ += slot.overrun ? 1 : 0;
    clocks_ += slot.clocks;
    totals_ += slot.counts;
    return slot;
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
