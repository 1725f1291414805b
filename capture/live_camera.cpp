#include "capture/live_camera.h"

#include <algorithm>
#include <utility>

#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};

}  // namespace

LiveCamera::LiveCamera(CaptureSession::Opener open, LiveCameraOptions options)
    : options_(std::move(options)),
      session_(std::move(open), options_.session),
      layout_(session_.layout()),
      description_(session_.description()),
      frames_(options_.waiting_frames, max_memory()),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

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
        if (begun_ && !frames_.push(std::move(*frame))) session_.count_own_drop(frame->record);
    } else if (!std::holds_alternative<NoFrame>(event)) {
        options_.tell(event);
    }
    if (auto* const lost = std::get_if<DeviceLost>(&event)) end_ = std::move(*lost);
}

std::optional<CapturedFrame> LiveCamera::next(std::chrono::milliseconds timeout) {
    auto frame = frames_.pop(timeout);
    if (!frame && frames_.ended() && failure_) std::rethrow_exception(failure_);
    return frame;
}

std::optional<DeviceLost> LiveCamera::end() const {
    return frames_.ended() ? end_ : std::nullopt;
}

}  // namespace stipple
