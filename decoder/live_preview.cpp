#include "decoder/live_preview.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <new>
#include <optional>
#include <utility>

#include "core/error.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// The calling thread runs when no other wants to. Where the system refuses, it runs as any other.
void run_when_idle() {
    const sched_param parameters{};
    static_cast<void>(sched_setscheduler(0, SCHED_IDLE, &parameters));
}

/// Undoes that, where the system lets us: without privileges it does not.
void stop_waiting_for_idle(std::thread& thread) {
    const sched_param parameters{};
    static_cast<void>(pthread_setschedparam(thread.native_handle(), SCHED_OTHER, &parameters));
}

constexpr std::chrono::seconds kSlowEnd{2};

/// CLOCK_MONOTONIC.
std::int64_t now_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

LivePreview::LivePreview(PreviewDecoder decoder, LivePreviewOptions options)
    : decoder_(std::move(decoder)), options_(std::move(options)), thread_([this] { run(); }) {}

LivePreview::~LivePreview() {
    give_up_ = true;
    finish([] {});
}

void LivePreview::add(std::span<const SamplePacket> packets, std::int64_t arrival_ns) {
    const std::int64_t slot = next_slot_++;
    if (handed_over_.load(std::memory_order_acquire)) {
        ++skipped_;
        return;
    }
    if (gathered_ == 0) {
        packet_count_ = 0;
        first_slot_ = slot;
    }
    if (gathered_ == decoder_.shown_slot()) shown_arrival_ns_ = arrival_ns;
    for (const SamplePacket& packet : packets) {
        if (packet_count_ == packets_.size()) packets_.emplace_back();
        packets_[packet_count_++] = packet;
    }
    if (++gathered_ < decoder_.slots()) return;
    gathered_ = 0;
    handed_over_.store(true, std::memory_order_release);
    wake_.release();
}

void LivePreview::run() {
    run_when_idle();
    for (;;) {
        wake_.acquire();
        if (!handed_over_.load(std::memory_order_acquire)) break;  // `finish` has called
        try {
            run_on_this_thread([this] { show(); });
        } catch (const std::bad_alloc&) {
            ++failed_;
        }
        handed_over_.store(false, std::memory_order_release);
    }
    ended_.release();
}

void LivePreview::show() {
    try {
        const auto keep_going = [this](double) { return !give_up_ && options_.keep_going(); };
        if (!keep_going(0)) return;
        const auto frame =
            decoder_.decode(first_slot_, std::span(packets_).first(packet_count_), keep_going);
        if (!frame) return;
        options_.show(*frame);
        ++made_;
        last_slot_ = frame->slot;
        delays_.add(static_cast<double>(now_ns() - shown_arrival_ns_) * 1e-3);
        failure_ = {};
    } catch (const Error& e) {
        fail(e.message());
    } catch (const std::exception& e) {
        fail(e.what());
    }
}

void LivePreview::fail(const Message& failure) {
    ++failed_;
    if (std::exchange(failure_, failure) != failure) options_.tell(failure);
}

void LivePreview::finish(const std::function<void()>& slow) {
    if (!thread_.joinable()) return;
    if (made_ + failed_ > 0) give_up_ = true;
    wake_.release();
    stop_waiting_for_idle(thread_);
    if (!ended_.try_acquire_for(kSlowEnd)) slow();
    thread_.join();
}

PreviewCounts LivePreview::counts() const {
    return {made_, failed_, skipped_, last_slot_, delays_};
}

}  // namespace stipple
