#include "capture/frame_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "capture/capture_session.h"
#include "core/memory_limit.h"

namespace stipple {
namespace {

double mb(std::size_t bytes) {
    return static_cast<double>(bytes) * 1e-6;
}

}  // namespace

bool FrameQueue::push(CapturedFrame&& frame) {
    const std::lock_guard lock(mutex_);
    const std::size_t bytes = bytes_ + frame.payload.size();
    const bool full = !frames_.empty() && (frames_.size() >= max_frames_ || bytes > max_bytes_);
    if (full || closed_) return false;
    frames_.push_back(std::move(frame));
    bytes_ = bytes;
    peak_ = std::max(peak_, frames_.size());
    changed_.notify_one();
    return true;
}

std::optional<CapturedFrame> FrameQueue::pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return can_pop(); });
    return take_oldest();
}

std::optional<CapturedFrame> FrameQueue::pop(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return can_pop(); });
    return take_oldest();
}

/// Precondition: the mutex is held.
std::optional<CapturedFrame> FrameQueue::take_oldest() {
    if (frames_.empty()) return std::nullopt;
    CapturedFrame frame = std::move(frames_.front());
    frames_.pop_front();
    bytes_ -= frame.payload.size();
    return frame;
}

void FrameQueue::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    changed_.notify_all();
}

std::size_t FrameQueue::close_and_clear() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    bytes_ = 0;
    changed_.notify_all();
    return std::exchange(frames_, {}).size();
}

bool FrameQueue::ended() const {
    const std::lock_guard lock(mutex_);
    return closed_ && frames_.empty();
}

std::size_t FrameQueue::peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
}

WaitingFrames waiting_frames(const Camera& camera, const WaitingFrames& wanted) {
    constexpr std::size_t kOtherFrames = CaptureSession::kOwnFrames + 1;
    const std::size_t frame = std::max<std::size_t>(camera.layout().payload_bytes(), 1);
    const std::size_t others = camera.buffer_bytes() + kOtherFrames * frame;
    if (others + frame > max_memory())  // asking for a description takes time
        check_memory(others + frame, camera.description().address,
                     fmt::format("the buffers of the camera ({:.1f} MB) and {} frames behind them "
                                 "({:.1f} MB)",
                                 mb(camera.buffer_bytes()), kOtherFrames + 1,
                                 mb((kOtherFrames + 1) * frame)));
    const std::size_t bytes = std::min<std::size_t>(wanted.bytes, max_memory() - others);
    return {std::clamp<std::size_t>(bytes / frame, 1, wanted.frames), bytes};
}

Message short_queue_text(const Camera& camera, std::size_t frames, std::size_t wanted) {
    return fmt::format(
               "{} frames may wait, not {}: so many ({:.1f} MB) and the buffers of the camera "
               "({:.1f} MB) together exceed {:.1f} MB, see ",
               frames, wanted, mb(wanted * camera.layout().payload_bytes()),
               mb(camera.buffer_bytes()), mb(max_memory())) +
           Parameter{"max_memory"};
}

}  // namespace stipple
