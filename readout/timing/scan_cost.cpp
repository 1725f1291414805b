#include "readout/timing/scan_cost.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>

#include "core/index.h"
#include "core/named_value.h"

namespace stipple {
namespace {

std::uint64_t wide(int value) {
    return static_cast<std::uint64_t>(value);
}

/// Clocks of a readout that its ADCs or its link take; the rest is overhead.
struct TimeShares {
    std::int64_t adc = 0;
    std::int64_t link = 0;
};

/// Rows that are converted and transferred in turns: each step takes its own time.
TimeShares shares_sequential(const SlotTimes& times) {
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
    add(last, last.frame_end > last.transfer_end + timing.blanking_clocks,
        last.convert_end - last.convert);
    return shares;
}

ReadoutLimit limit_of(const ReadoutTiming& timing, const SlotTimes& times) {
    if (times.rows.empty()) return ReadoutLimit::kRowOverhead;
    const bool sequential = timing.row_timing == RowTiming::kSequential;
    const auto [adc, link] =
        sequential ? shares_sequential(times) : shares_overlapped(timing, times);
    const std::int64_t overhead = times.end - times.begin - adc - link;
    const std::int64_t longest = std::max({adc, link, overhead});
    if (longest == link) return ReadoutLimit::kLink;
    return longest == adc ? ReadoutLimit::kAdc : ReadoutLimit::kRowOverhead;
}

/// By phase, whether some pixel is open.
std::vector<bool> open_phases(const ExposureSchedule& schedule) {
    std::vector<bool> open(index(schedule.period_slots()));
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            for (const Exposure& exposure : schedule.exposures(row, col))
                for (int slot = 0; slot < exposure.span_slots(); ++slot)
                    if ((exposure.open_slots >> static_cast<unsigned>(slot) & 1U) != 0)
                        open[(exposure.first_slot + index(slot)) % open.size()] = true;
    return open;
}

/// Adds a row to deadlines of which those with more slots end later.
void add_deadline(ScanDeadline added, std::vector<ScanDeadline>& deadlines) {
    const auto at = std::ranges::lower_bound(deadlines, added.slots, {}, &ScanDeadline::slots);
    if (at != deadlines.end() && at->slots == added.slots)
        at->end = std::max(at->end, added.end);  // ADCs that convert less can be done earlier
    else if (at == deadlines.begin() || std::prev(at)->end < added.end)
        deadlines.insert(at, added);
    std::erase_if(deadlines, [&](const ScanDeadline& other) {
        return other.slots > added.slots && other.end <= added.end;
    });
}

}  // namespace

std::string_view name_of(ReadoutLimit limit) {
    constexpr auto kLimits =
        std::to_array<NamedValue<ReadoutLimit>>({{"adc", ReadoutLimit::kAdc},
                                                 {"link", ReadoutLimit::kLink},
                                                 {"row_overhead", ReadoutLimit::kRowOverhead},
                                                 {"code_load", ReadoutLimit::kCodeLoad}});
    return name_in(kLimits, limit);
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

ScanCosts::ScanCosts(const ReadoutTiming& timing, const ExposureSchedule& schedule,
                     FrameShape shape)
    : timing_(timing),
      schedule_(schedule),
      shape_(shape),
      row_loads_(timing_, schedule, shape),
      first_steady_slot_(std::max(schedule.longest_span_slots(), 1) - 1),
      exposes_(timing.exposes_while_reading ? std::vector<bool>() : open_phases(schedule)),
      by_phase_(index(schedule.period_slots())),
      known_(by_phase_.size()) {
    timing_.code_load_clocks = code_load_clocks(timing, shape.rows);
}

const ScanCost& ScanCosts::of(std::int64_t slot) {
    if (slot < first_steady_slot_) return early_ = compute(slot);
    const auto phase = static_cast<std::size_t>(slot % schedule_.period_slots());
    if (!known_[phase]) by_phase_[phase] = compute(slot);
    known_[phase] = true;
    return by_phase_[phase];
}

SlotTimes ScanCosts::times(std::int64_t slot, std::int64_t begin) {
    row_loads_.list(slot, loads_);
    return read_slot(timing_, shape_.cols, loads_, begin);
}

int ScanCosts::closed_slots_after(std::int64_t slot) const {
    int closed = 0;
    while (!exposes(slot + 1 + closed)) ++closed;  // some slot is open, as `slot` is read
    return closed;
}

int ScanCosts::deadline_slots(std::int64_t slot, int row) const {
    return timing_.exposes_while_reading ? row_loads_.due_again_slots(slot, row)
                                         : closed_slots_after(slot);
}

int ScanCosts::longest_deadline_slots() const {
    int longest = 0;
    for (std::int64_t slot = first_steady_slot_;
         slot < first_steady_slot_ + schedule_.period_slots(); ++slot)
        for (int row = 0; row < shape_.rows; ++row)
            if (row_loads_.is_due(slot, row))
                longest = std::max(longest, deadline_slots(slot, row));
    return longest;
}

void ScanCosts::count(const RowTimes& row, ReadoutCounts& counts) const {
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

ScanCost ScanCosts::compute(std::int64_t slot) {
    const SlotTimes times = this->times(slot, 0);
    ScanCost cost;
    for (const RowTimes& row : times.rows) {
        count(row, cost.counts);
        if (row.load.row >= 0)
            add_deadline({deadline_slots(slot, row.load.row), row.frame_end}, cost.deadlines);
    }
    cost.settle_clocks = times.settle;
    cost.counts.readout_clocks = times.end;
    cost.counts.energy_pj += timing_.code_bit_pj * static_cast<double>(shape_.pixels());
    cost.limit =
        timing_.code_load_clocks > times.end ? ReadoutLimit::kCodeLoad : limit_of(timing_, times);
    return cost;
}

}  // namespace stipple
