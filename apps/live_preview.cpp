#include "apps/live_preview.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "apps/interrupt.h"
#include "apps/report/preview_picture.h"
#include "apps/report/standard_error.h"
#include "capture/host_clock.h"
#include "core/parallel.h"
#include "io/disk_sync.h"

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

constexpr std::chrono::seconds kPollInterval{2};

}  // namespace

LivePreview::LivePreview(std::filesystem::path file, PreviewDecoder decoder)
    : file_(std::move(file)), decoder_(std::move(decoder)), thread_([this] { run(); }) {}

LivePreview::~LivePreview() {
    give_up_ = true;
    finish();
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
    const NoSync no_sync;  // the next picture comes soon
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
        const auto goes_on = [this](double) { return !give_up_ && stop_signal() == 0; };
        if (!goes_on(0)) return;
        const auto frame =
            decoder_.decode(first_slot_, std::span(packets_).first(packet_count_), goes_on);
        if (!frame) return;
        write_preview(file_, *frame);
        ++made_;
        last_slot_ = frame->slot;
        delays_.add(static_cast<double>(monotonic_ns() - shown_arrival_ns_) * 1e-3);
        failure_.clear();
    } catch (const std::exception& e) {
        ++failed_;
        if (std::exchange(failure_, e.what()) == failure_) return;
        say_error("no preview: {}; the recording goes on", failure_);
    }
}

void LivePreview::finish() {
    if (!thread_.joinable()) return;
    if (made_ + failed_ > 0) give_up_ = true;
    wake_.release();
    stop_waiting_for_idle(thread_);
    if (!ended_.try_acquire_for(kPollInterval))
        say_error(
            "the recording is complete; its preview ends slowly, as the machine is "
            "busy. Ctrl-C twice does not wait");
    thread_.join();
}

nlohmann::ordered_json LivePreview::json() const {
    const FrameShape shape = decoder_.shape();
    nlohmann::ordered_json json{
        {"file", file_.string()},    {"width", shape.cols},  {"height", shape.rows},
        {"slots", decoder_.slots()}, {"made", made_.load()}, {"failed", failed_.load()},
        {"skipped_slots", skipped_}, {"last_slot", nullptr}, {"delay_ms", nullptr}};
    if (made_ == 0) return json;
    json["last_slot"] = last_slot_;
    json["delay_ms"] = {{"median", delays_.quantile_us(0.5) * 1e-3},
                        {"max", delays_.longest_us() * 1e-3}};
    return json;
}

std::string LivePreview::text() const {
    const FrameShape shape = decoder_.shape();
    std::string text =
        fmt::format("preview {}: {} x {} from {} slots; made {}, failed {}", file_.string(),
                    shape.cols, shape.rows, decoder_.slots(), made_.load(), failed_.load());
    if (made_ > 0)
        text += fmt::format("; {:.1f} s behind its slot, at most {:.1f} s",
                            delays_.quantile_us(0.5) * 1e-6, delays_.longest_us() * 1e-6);
    return text;
}

}  // namespace stipple
