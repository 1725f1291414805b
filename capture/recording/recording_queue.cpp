#include "capture/recording/recording_queue.h"

#include <limits>
#include <utility>

namespace stipple {

RecordingQueue::RecordingQueue(RecordingWriter& writer, std::size_t max_bytes)
    : writer_(writer),
      frames_(std::numeric_limits<std::size_t>::max(), max_bytes),
      thread_([this] { run(); }) {}

RecordingQueue::~RecordingQueue() {
    stop();
}

bool RecordingQueue::push(CapturedFrame&& frame) {
    const bool taken = frames_.push(std::move(frame));
    if (!taken) ++dropped_;
    return taken;
}

void RecordingQueue::run() {
    try {
        while (const auto frame = frames_.pop()) writer_.write(*frame);
    } catch (...) {
        failure_ = std::current_exception();
        dropped_ += 1 + frames_.close_and_clear();
        failed_ = true;
    }
}

void RecordingQueue::stop() {
    frames_.close();
    if (thread_.joinable()) thread_.join();
}

void RecordingQueue::drain() {
    stop();
    if (failure_) std::rethrow_exception(failure_);
}

}  // namespace stipple
