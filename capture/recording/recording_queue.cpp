#include "capture/recording/recording_queue.h"

#include <algorithm>
#include <utility>

namespace stipple {

RecordingQueue::RecordingQueue(RecordingWriter& writer, std::size_t max_bytes)
    : writer_(writer), max_bytes_(max_bytes), thread_([this] { run(); }) {}

RecordingQueue::~RecordingQueue() {
    stop();
}

bool RecordingQueue::push(CapturedFrame&& frame) {
    const std::lock_guard lock(mutex_);
    const bool full = !frames_.empty() && bytes_ + frame.payload.size() > max_bytes_;
    if (full || failure_) {
        ++dropped_;
        return false;
    }
    bytes_ += frame.payload.size();
    peak_bytes_ = std::max(peak_bytes_, bytes_);
    frames_.push_back(std::move(frame));
    changed_.notify_one();
    return true;
}

void RecordingQueue::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [&] { return stopping_ || !frames_.empty(); });
        if (frames_.empty()) return;
        const CapturedFrame frame = std::move(frames_.front());
        frames_.pop_front();
        lock.unlock();
        std::exception_ptr failure;
        try {
            writer_.write(frame);
        } catch (...) {
            failure = std::current_exception();
        }
        lock.lock();
        bytes_ -= frame.payload.size();
        if (!failure) continue;
        failure_ = failure;
        dropped_ += 1 + frames_.size();
        frames_.clear();
        bytes_ = 0;
        return;
    }
}

void RecordingQueue::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
        changed_.notify_one();
    }
    if (thread_.joinable()) thread_.join();
}

void RecordingQueue::drain() {
    stop();
    if (failure_) std::rethrow_exception(failure_);
}

bool RecordingQueue::failed() const {
    const std::lock_guard lock(mutex_);
    return failure_ != nullptr;
}

std::uint64_t RecordingQueue::dropped() const {
    const std::lock_guard lock(mutex_);
    return dropped_;
}

std::size_t RecordingQueue::peak_bytes() const {
    const std::lock_guard lock(mutex_);
    return peak_bytes_;
}

}  // namespace stipple
