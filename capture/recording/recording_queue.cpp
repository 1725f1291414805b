#include "capture/recording/recording_queue.h"

#include <utility>

namespace stipple {

RecordingQueue::RecordingQueue(RecordingWriter& writer, const WaitingFrames& most,
                               GiveBack give_back)
    : writer_(writer),
      frames_(most.frames, most.bytes),
      give_back_(std::move(give_back)),
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
        while (auto frame = frames_.pop()) {
            writer_.write(*frame);
            if (give_back_) give_back_(std::move(frame->payload));
        }
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
