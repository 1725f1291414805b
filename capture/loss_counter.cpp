#include "capture/loss_counter.h"

#include <algorithm>
#include <numeric>

namespace stipple {
namespace {

TransportCounts sum(TransportCounts a, const TransportCounts& b) {
    a.underruns += b.underruns;
    a.packets_resent += b.packets_resent;
    a.packets_missing += b.packets_missing;
    a.socket_drops += b.socket_drops;
    a.link_faults += b.link_faults;
    a.size_mismatches += b.size_mismatches;
    return a;
}

}  // namespace

std::uint64_t FrameGap::total() const {
    return std::accumulate(lost.begin(), lost.end(), std::uint64_t{0});
}

GapCause FrameGap::cause() const {
    const auto* const most = std::max_element(lost.begin(), lost.end());
    return *most == 0 ? GapCause::kNone : static_cast<GapCause>(most - lost.begin());
}

GapCause cause_of(const TransportCounts& before, const TransportCounts& after,
                  bool incomplete_frames) {
    if (after.underruns > before.underruns) return GapCause::kHostUnderrun;
    if (after.socket_drops > before.socket_drops || after.link_faults > before.link_faults)
        return GapCause::kTransport;
    if (after.packets_missing > before.packets_missing && !incomplete_frames)
        return GapCause::kTransport;
    return GapCause::kDevice;
}

void LossCounter::begin_epoch(Clock::time_point now) {
    counted_ = {};
    counted_at_ = now;
    incomplete_since_ = false;
}

void LossCounter::end_epoch(const Camera& camera, Clock::time_point now) {
    read(camera, now);
    earlier_epochs_ = sum(earlier_epochs_, std::exchange(counted_, {}));
}

void LossCounter::note_frame(const Camera& camera, Clock::time_point now) {
    if (now - counted_at_ < kCountEvery) return;
    const std::uint64_t unexplained = counted_.underruns;
    read(camera, now);
    // An underrun always costs a frame: where none is missing yet, frames from before it wait.
    counted_.underruns = unexplained;
}

void LossCounter::count_unexplained(const Camera& camera, std::uint64_t frames,
                                    Clock::time_point now) {
    const TransportCounts before = counted_;
    const bool explained = incomplete_since_;
    read(camera, now);
    count(cause_of(before, counted_, explained), frames);
}

void LossCounter::count(GapCause cause, std::uint64_t frames) {
    gap_.add(cause, frames);
    lost_[static_cast<std::size_t>(cause)] += frames;
}

void LossCounter::count_last_underruns(const Camera& camera, Clock::time_point now) {
    const std::uint64_t before = counted_.underruns;
    read(camera, now);
    lost_[static_cast<std::size_t>(GapCause::kHostUnderrun)] += counted_.underruns - before;
}

TransportCounts LossCounter::transport(const Camera* camera) const {
    return camera == nullptr ? earlier_epochs_ : sum(earlier_epochs_, camera->counts());
}

void LossCounter::read(const Camera& camera, Clock::time_point now) {
    counted_ = camera.counts();
    counted_at_ = now;
    incomplete_since_ = false;
}

}  // namespace stipple
