#include "capture/live_camera.h"

#include <algorithm>
#include <utility>

#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};
/// Beside those that wait: of the session, and the one in use.
constexpr std::size_t kOtherFrames = CaptureSession::kOwnFrames + 1;

/// As many of the `wanted` frames as `max_memory` has room for, but at least one.
std::size_t waiting_frames(std::size_t wanted, const FrameLayout& layout) {
    const std::size_t room = max_memory() / std::max<std::size_t>(layout.payload_bytes(), 1);
    return std::max<std::size_t>(std::min(wanted, room - std::min(room, kOtherFrames)), 1);
}

}  // namespace

LiveCamera::LiveCamera(CaptureSession::Opener open, LiveCameraOptions options)
    : options_(std::move(options)),
      session_(std::move(open), options_.session),
      layout_(session_.layout()),
      description_(session_.description()),
      frames_(waiting_frames(options_.waiting_frames, layout_), max_memory()) {
    session_.reserve(frames_.max_frames() + 1);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

LiveCamera::~LiveCamera() {
    stop();
}

SessionTotals LiveCamera::stop() {
    thread_.request_stop();
    begin();
    if (thread_.joinable()) thread_.join();
    return session_.totals();
}

void LiveCamera::begin() {
    begun_ = true;
    begun_.notify_all();
}

void LiveCamera::run(const std::stop_token& stop) noexcept {
    try {
        if (options_.from_start) begun_.wait(false);
        while (!stop.stop_requested() && !end_) take(session_.next(kPollInterval));
    } catch (...) {
        failure_ = std::current_exception();
    }
    frames_.close();
}

void LiveCamera::take(SessionEvent event) {
    if (auto* const frame = std::get_if<CapturedFrame>(&event)) {
        if (begun_ && frames_.push(std::move(*frame))) return;
        if (begun_) session_.count_queue_drop(frame->record);
        session_.give_back(std::move(frame->payload));
    } else if (!std::holds_alternative<NoFrame>(event)) {
        options_.tell(event);
    }
    if (auto* const lost = std::get_if<DeviceLost>(&event)) end_ = std::move(*lost);
}

bool LiveCamera::next(CapturedFrame& frame, std::chrono::milliseconds timeout) {
    session_.give_back(std::move(frame.payload));
    auto popped = frames_.pop(timeout);
    if (!popped && frames_.ended() && failure_) std::rethrow_exception(failure_);
    if (popped) frame = std::move(*popped);
    return popped.has_value();
}

std::optional<DeviceLost> LiveCamera::end() const {
    return frames_.ended() ? end_ : std::nullopt;
}

}  // namespace stipple
