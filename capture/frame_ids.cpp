#include "capture/frame_ids.h"

namespace stipple {

FrameIds::Step FrameIds::next(std::uint64_t wire_id) noexcept {
    Step step;
    if (last_wire_id_) {
        const std::uint64_t last = *last_wire_id_;
        const std::uint64_t forward = wire_id >= last ? wire_id - last : period_ - (last - wire_id);
        step.restarted = forward == 0 || forward > period_ / 2;
        if (!step.restarted) step.lost = forward - 1;
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
