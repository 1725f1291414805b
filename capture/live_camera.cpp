#include "capture/live_camera.h"

#include <utility>

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};

}  // namespace

LiveCamera::LiveCamera(CaptureSession::Opener open, LiveCameraOptions options)
    : options_(std::move(options)),
      session_(std::move(open), options_.session,
               [this](const Camera& camera) { return plan_queue(camera); }),
      layout_(session_.layout()),
      description_(session_.description()),
      frames_(waiting_.frames, waiting_.bytes) {
    if (!short_queue_.empty()) description_.warnings.push_back(short_queue_);
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

/// Before it starts. Returns the frames that wait, and the one in use.
std::size_t LiveCamera::plan_queue(const Camera& camera) {
    const std::size_t wanted = options_.waiting_frames;
    waiting_ = waiting_frames(camera, {.frames = wanted});
    if (waiting_.frames < wanted) short_queue_ = short_queue_text(camera, waiting_.frames, wanted);
    return waiting_.frames + 1;
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
