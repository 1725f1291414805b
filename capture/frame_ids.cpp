#include "capture/frame_ids.h"

namespace stipple {
namespace {

/// From one frame to the next, by which a counter that began anew is known.
constexpr std::uint64_t kMaxSteps = 8;

/// Whether both are stamped, by the same clock.
bool have_stamps(const FrameRecord& a, const FrameRecord& b) {
    return a.stamp_source == b.stamp_source && a.stamp_source != StampSource::kNone;
}

/// Of a frame with a past id: its clock went on, or, of a camera without clock, its counter stands.
bool begins_anew(const FrameRecord& record, const FrameRecord& last) {
    return have_stamps(record, last) ? record.device_ns > last.device_ns
                                     : record.wire_id == last.wire_id;
}

}  // namespace

std::uint64_t FrameIds::steps(std::uint64_t from, std::uint64_t to) const noexcept {
    return to >= from ? to - from : period_ - (from - to);
}

bool FrameIds::is_past(std::uint64_t wire_id) const noexcept {
    return last_wire_id_ &&
           (wire_id == *last_wire_id_ || steps(*last_wire_id_, wire_id) > period_ / 2);
}

FrameIds::Step FrameIds::next(std::uint64_t wire_id) noexcept {
    Step step;
    if (last_wire_id_) {
        step.restarted = is_past(wire_id);
        if (!step.restarted) step.lost = steps(*last_wire_id_, wire_id) - 1;
    }
    step.id = next_id_ + step.lost;
    next_id_ = step.id + 1;
    last_wire_id_ = wire_id;
    return step;
}

void FrameIds::restart(std::uint64_t period, std::uint64_t skipped) noexcept {
    period_ = period;
    next_id_ += skipped;
    last_wire_id_.reset();
}

bool RepeatFilter::follows_doubtful(const FrameRecord& record, const FrameIds& ids) const {
    const FrameRecord& first = doubtful_->record;
    const std::uint64_t steps = ids.steps(first.wire_id, record.wire_id);
    const bool is_older = have_stamps(record, first) && record.device_ns < first.device_ns;
    return steps > 0 && steps <= kMaxSteps && !is_older;
}

RepeatFilter::Sorted RepeatFilter::take(CapturedFrame frame, const FrameIds& ids,
                                        const FrameRecord* last) {
    const FrameRecord& record = frame.record;
    const bool is_past = last != nullptr && ids.is_past(record.wire_id);
    // A packet that was resent too late: Aravis makes a frame of it again, long after the frame.
    if (is_past && record.status != FrameStatus::kComplete)
        return {.next = {}, .left_out = std::move(frame)};
    if (is_past && doubtful_ && follows_doubtful(record, ids)) {
        waiting_ = std::move(frame);
        return {.next = take_doubtful(), .left_out = {}};
    }
    Sorted sorted{.next = {}, .left_out = take_doubtful()};
    if (is_past && !begins_anew(record, *last)) {
        doubtful_ = std::move(frame);
    } else {
        sorted.next = std::move(frame);
    }
    return sorted;
}

}  // namespace stipple
