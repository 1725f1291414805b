#include "stream/schedule_switch.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stipple {

ReadoutValues readout_values(const Calibration& calibration) {
    return {.rounding = calibration.rounding,
            .black_level_dn = calibration.black_level_dn,
            .gain_e_per_dn = calibration.gain_e_per_dn,
            .read_noise_e = calibration.read_noise_e,
            .full_well_e = calibration.full_well_e,
            .electrons_per_unit = calibration.electrons_per_unit};
}

Calibration with_values(Calibration calibration, const ReadoutValues& values) {
    calibration.rounding = values.rounding;
    calibration.black_level_dn = values.black_level_dn;
    calibration.gain_e_per_dn = values.gain_e_per_dn;
    calibration.read_noise_e = values.read_noise_e;
    calibration.full_well_e = values.full_well_e;
    calibration.electrons_per_unit = values.electrons_per_unit;
    return calibration;
}

namespace {

/// The last switch that is not after `slot`, or null.
const ScheduleSwitch* switch_at(const StreamHeader& stream, std::int64_t slot) {
    const auto after = std::ranges::upper_bound(stream.switches, slot, {}, &ScheduleSwitch::slot);
    return after == stream.switches.begin() ? nullptr : &*(after - 1);
}

}  // namespace

Calibration calibration_at(const StreamHeader& stream, std::int64_t slot) {
    const ScheduleSwitch* const last = switch_at(stream, slot);
    return last == nullptr ? stream.calibration : with_values(stream.calibration, last->values);
}

std::vector<SchedulePart> schedule_parts(const StreamHeader& stream) {
    std::vector<SchedulePart> parts{{&stream.schedule}};
    int number = 0;
    for (const ScheduleSwitch& part : stream.switches) {
        parts.push_back({&part.schedule, part.slot, part.number == number + 1});
        number = part.number;
    }
    return parts;
}

SchedulePart schedule_at(const StreamHeader& stream, std::int64_t slot) {
    const ScheduleSwitch* const last = switch_at(stream, slot);
    return last == nullptr ? SchedulePart{&stream.schedule}
                           : SchedulePart{&last->schedule, last->slot};
}

std::optional<std::string> JoinedExposures::fault(const StreamHeader& stream,
                                                  ScheduleSwitch& next) {
    if (next.schedule.interleaved() || next.schedule.weighted())
        return "a switch to a schedule with weights or interleaved exposures is not possible";
    std::vector<SchedulePart> parts = schedule_parts(stream);
    std::vector<std::int64_t> slots;
    for (const ScheduleSwitch& old : stream.switches) slots.push_back(old.slot);
    const auto all =
        slots.begin() + static_cast<std::ptrdiff_t>(std::min(passed_.size(), slots.size()));
    if (!unread_ || passed_ != std::vector<std::int64_t>(slots.begin(), all)) {
        unread_.emplace(stream.shape);
        passed_.clear();
    }
    while (passed_.size() < slots.size()) {
        unread_->pass(std::span(parts).first(passed_.size() + 2));
        passed_.push_back(slots[passed_.size()]);
    }
    parts.push_back({&next.schedule, next.slot, next.number == last_switch(stream) + 1});
    UnreadSlots unread = *unread_;
    unread.pass(parts);
    const auto [at, longest] = unread.longest(parts.back());
    if (longest > kMaxExposureSlots)
        return fmt::format(
            "with a switch at slot {} pixel ({}, {}) has an exposure of {} slots up to slot {}; "
            "there are 64 at most",
            next.slot, at.row, at.col, longest, at.slot);
    next.longest_span_slots =
        std::max(static_cast<int>(longest), next.schedule.longest_span_slots());
    return std::nullopt;
}

}  // namespace stipple
