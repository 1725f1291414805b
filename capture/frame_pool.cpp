#include "capture/frame_pool.h"

#include <utility>

namespace stipple {

void FramePool::reserve(std::size_t frames, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    frames_ = frames;
    bytes_ = bytes;
    free_.reserve(frames);
    for (std::size_t i = 0; i < frames; ++i) {
        free_.emplace_back(bytes);  // zeros: each page is written to
        free_.back().clear();
    }
}

std::vector<std::uint8_t> FramePool::take() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
        ++misses_;
        return {};
    }
    auto payload = std::move(free_.back());
    free_.pop_back();
    return payload;
}

void FramePool::give_back(std::vector<std::uint8_t>&& payload) {
    const std::lock_guard lock(mutex_);
    if (free_.size() == frames_ || payload.capacity() < bytes_) return;
    payload.clear();
    free_.push_back(std::move(payload));
}

std::uint64_t FramePool::misses() const {
    const std::lock_guard lock(mutex_);
    return misses_;
}

}  // namespace stipple
