#include "capture/frame_ids.h"

namespace stipple {

/// How far the counter has moved since the last frame.
std::uint64_t FrameIds::forward(std::uint64_t wire_id) const noexcept {
    const std::uint64_t last = *last_wire_id_;
    return wire_id >= last ? wire_id - last : period_ - (last - wire_id);
}

bool FrameIds::is_past(std::uint64_t wire_id) const noexcept {
    return last_wire_id_ && (wire_id == *last_wire_id_ || forward(wire_id) > period_ / 2);
}

FrameIds::Step FrameIds::next(std::uint64_t wire_id) noexcept {
    Step step;
    if (last_wire_id_) {
        step.restarted = is_past(wire_id);
        if (!step.restarted) step.lost = forward(wire_id) - 1;
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
