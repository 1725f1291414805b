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
#include "core/index.h"
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

/// Slots that come from one frame to the next, at least.
constexpr std::int64_t kStepSlots = 8;

/// CLOCK_MONOTONIC.
std::int64_t now_ns() {
    return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

LivePreview::LivePreview(StreamHeader header, const PreviewOptions& decoding,
                         LivePreviewOptions options)
    : header_(std::move(header)),
      decoder_(header_, decoding),
      options_(std::move(options)),
      slots_(2 * index(decoder_.slots()) + 1),
      thread_([this] { run(); }) {}

LivePreview::~LivePreview() {
    give_up_ = true;
    finish([] {});
}

LivePreview::Slot& LivePreview::free_slot() {
    return *std::ranges::find_if(slots_, [&](const Slot& slot) {
        return std::ranges::find(newest_, &slot) == newest_.end() &&
               std::ranges::find(window_, &slot) == window_.end();
    });
}

void LivePreview::add(std::span<const SamplePacket> packets, std::int64_t arrival_ns) {
    if (newest_.size() == index(decoder_.slots())) newest_.erase(newest_.begin());
    Slot& slot = free_slot();
    slot.packet_count = packets.size();
    slot.packets.resize(std::max(slot.packets.size(), packets.size()));
    std::ranges::copy(packets, slot.packets.begin());
    slot.arrival_ns = arrival_ns;
    newest_.push_back(&slot);
    ++next_slot_;
    if (newest_.size() < index(decoder_.slots()) || next_slot_ < window_end_ + kStepSlots ||
        handed_over_.load(std::memory_order_acquire))
        return;
    hand_over();
}

void LivePreview::hand_over() {
    skipped_ += std::max<std::int64_t>(next_slot_ - decoder_.slots() - window_end_, 0);
    window_ = newest_;
    window_end_ = next_slot_;
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
        const PreviewSlots slots = decoder_.newest(window_end_);
        std::size_t count = 0;
        for (const Slot* slot : window_)
            for (const SamplePacket& packet : std::span(slot->packets).first(slot->packet_count)) {
                if (count == packets_.size()) packets_.emplace_back();
                packets_[count++] = packet;
            }
        const auto frame = decoder_.decode(slots, std::span(packets_).first(count), keep_going);
        if (!frame) return;
        options_.show(*frame);
        ++made_;
        last_slot_ = frame->slot;
        delays_.add(static_cast<double>(
                        now_ns() - window_[index(slots.shown - slots.range.begin)]->arrival_ns) *
                    1e-3);
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
    if (window_end_ == 0 && next_slot_ > 0) hand_over();  // fewer slots than a window
    if (made_ + failed_ > 0) give_up_ = true;
    wake_.release();
    stop_waiting_for_idle(thread_);
    if (!ended_.try_acquire_for(kSlowEnd)) slow();
    thread_.join();
}

PreviewCounts LivePreview::counts() const {
    return {made_, failed_, skipped_ + next_slot_ - window_end_, last_slot_, delays_};
}

}  // namespace stipple
