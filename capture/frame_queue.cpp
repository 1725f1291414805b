#include "capture/frame_queue.h"

#include <algorithm>
#include <utility>

namespace stipple {

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

}  // namespace stipple
