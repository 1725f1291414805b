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
      most_(
          std::clamp<std::size_t>(max_memory() / std::max<std::size_t>(layout_.payload_bytes(), 1),
                                  1, options_.waiting_frames)),
      thread_([this](const std::stop_token& stop) { run(stop); }) {}

LiveCamera::~LiveCamera() {
    stop();
}

SessionTotals LiveCamera::stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
    return session_.totals();
}

void LiveCamera::begin() {
    const std::lock_guard lock(mutex_);
    begun_ = true;
    changed_.notify_all();
}

void LiveCamera::take(CapturedFrame frame) {
    const std::lock_guard lock(mutex_);
    if (!begun_) return;
    if (frames_.size() >= most_) return session_.count_own_drop(frame.record);
    frames_.push_back(std::move(frame));
    peak_ = std::max(peak_, frames_.size());
    changed_.notify_all();
}

void LiveCamera::run(const std::stop_token& stop) noexcept try {
    if (options_.from_start) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, stop, [&] { return begun_; });
    }
    while (!stop.stop_requested()) {
        SessionEvent event = session_.next(kPollInterval);
        if (auto* const frame = std::get_if<CapturedFrame>(&event))
            take(std::move(*frame));
        else if (!std::holds_alternative<NoFrame>(event))
            options_.tell(event);
        if (const auto* const lost = std::get_if<DeviceLost>(&event)) {
            const std::lock_guard lock(mutex_);
            end_ = *lost;
            changed_.notify_all();
            return;
        }
    }
} catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
    changed_.notify_all();
}

std::optional<CapturedFrame> LiveCamera::next(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return !frames_.empty() || end_ || failure_; });
    if (frames_.empty() && failure_) std::rethrow_exception(failure_);
    if (frames_.empty()) return std::nullopt;
    CapturedFrame frame = std::move(frames_.front());
    frames_.pop_front();
    return frame;
}

std::optional<DeviceLost> LiveCamera::end() const {
    const std::lock_guard lock(mutex_);
    return frames_.empty() ? end_ : std::nullopt;
}

std::size_t LiveCamera::peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
}

}  // namespace stipple
