#include "capture/frame_ids.h"

namespace stipple {

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

}  // namespace stipple
