#include "apps/live_camera.h"

#include <algorithm>
#include <utility>

#include "apps/session_report.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPatience{50};

}  // namespace

LiveCamera::LiveCamera(const CameraArguments& camera, const SessionOptions& session,
                       std::size_t waiting_frames)
    : replay_(is_replay(camera)),
      session_([camera, settings = camera_settings(
                            camera)] { return open_picture_camera(camera, settings); },
               session_options(camera, session)),
      layout_(session_.layout()),
      description_(session_.description()),
      most_(std::clamp<std::size_t>(
          most_memory() / std::max<std::size_t>(layout_.payload_bytes(), 1), 1, waiting_frames)),
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
    if (replay_) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, stop, [&] { return begun_; });
    }
    while (!stop.stop_requested()) {
        SessionEvent event = session_.next(kPatience);
        if (auto* const frame = std::get_if<CapturedFrame>(&event)) take(std::move(*frame));
        if (const auto* const outage = std::get_if<Outage>(&event)) say(*outage);
        if (const auto* const recovery = std::get_if<Recovery>(&event)) say(*recovery);
        if (const auto* const lost = std::get_if<DeviceLost>(&event)) {
            say_warning(lost->warning);
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
