#include "capture/live_emulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <utility>

#include "capture/camera_kind.h"
#include "capture/frame_record.h"
#include "capture/recording/recording_reader.h"
#include "capture/recording/replay_camera.h"
#include "core/gap_limit.h"
#include "core/message.h"
#include "readout/emulator.h"
#include "readout/footage_origin.h"
#include "readout/sensor_file.h"

namespace stipple {
namespace {

constexpr std::chrono::milliseconds kPollInterval{50};

/// A random number: packets of two recordings with the same settings are told apart by it
/// (docs/stream_format.md, "Packet").
std::string new_recording_name() {
    std::random_device random;
    return fmt::format("{:08x}{:08x}", random(), random());
}

}  // namespace

std::string left_out_text(const std::string& address, const LeftOut& left_out) {
    return fmt::format(
        "{}: {} frames are missing before a frame, too many in proportion to those that came: the "
        "previous frame replaces {} of them, so slots from {} on come too early",
        address, left_out.missing, left_out.held, left_out.first_slot);
}

LiveEmulator::LiveEmulator(LiveCamera& camera, FrameLight to_light, StreamRecorder& recorder,
                           LiveEmulatorOptions options)
    : camera_(camera),
      to_light_(std::move(to_light)),
      recorder_(recorder),
      options_(std::move(options)),
      light_(to_light_.shape().sites()) {
    // Threads and code are in place before the first frame comes.
    static_cast<void>(Emulator(recorder_.emulator().setup()).expose(light_));
}

LiveEmulation LiveEmulator::run(const Observer& progress) {
    const std::int64_t start_ns = monotonic_ns();
    const auto elapsed_s = [&] { return static_cast<double>(monotonic_ns() - start_ns) * 1e-9; };
    CapturedFrame frame;
    camera_.begin();
    try {
        while (progress(result_) && !result_.end &&
               !options_.limits.reached(result_.latencies.count(), elapsed_s())) {
            if (camera_.next(frame, kPollInterval))
                take(frame);
            else
                end(camera_.end());
        }
    } catch (...) {
        result_.failure = std::current_exception();
    }
    if (const auto passed_s = static_cast<double>(last_done_ns_ - first_done_ns_) * 1e-9;
        passed_s > 0)
        result_.slots_per_second =
            static_cast<double>(recorder_.emulator().stats().slots - 1) / passed_s;
    return std::move(result_);
}

void LiveEmulator::end(std::optional<DeviceLost> lost) {
    if (lost && !lost->at_end && !lost->bad_file) lost->reason = "camera lost: " + lost->reason;
    result_.end = std::move(lost);
}

/// As many of the slots before a frame as are in proportion to the frames: what a camera or a clock
/// says of them has no limit.
std::uint64_t LiveEmulator::lost_to_hold(std::uint64_t lost) {
    const auto frames = static_cast<std::int64_t>(result_.latencies.count()) + 1;
    const auto max_held = static_cast<std::uint64_t>(max_missing_slots(frames, to_light_.shape()));
    const std::uint64_t held = std::min(lost, max_held - std::min(max_held, result_.held_slots));
    if (held < lost && result_.unheld_slots == 0 && options_.tell)
        options_.tell(
            {lost, held, recorder_.emulator().stats().slots + static_cast<std::int64_t>(held)});
    result_.unheld_slots += lost - held;
    return held;
}

void LiveEmulator::hold_missing(const FrameRecord& record) {
    const bool complete = record.status == FrameStatus::kComplete;
    const GapFiller::Gap gap = filler_.next(record, complete);
    const std::uint64_t incomplete = complete ? 0 : 1;
    if (gap.held == 0) {  // no slot yet, or nothing is missing
        result_.totals.missing_before_first += gap.lost + incomplete;
        return;
    }
    const std::uint64_t lost = lost_to_hold(gap.lost);
    const std::uint64_t unread = record.cause == GapCause::kQueueDrop ? lost : 0;
    const std::uint64_t slots = lost + incomplete;
    for (std::uint64_t slot = 0; slot < slots; ++slot)
        expose({{}, {}, monotonic_ns()}, slot >= unread);
    result_.held_slots += slots;
    result_.dropped_slots += unread;
    result_.totals.lost[static_cast<std::size_t>(record.cause)] += gap.lost;
    result_.totals.incomplete += incomplete;
}

/// `slot` gets its packets here.
void LiveEmulator::expose(const LiveSlot& slot, bool is_read) {
    if (options_.before_slot) options_.before_slot(recorder_);
    const auto packets = is_read ? recorder_.expose(light_) : recorder_.expose_unread(light_);
    if (options_.show) options_.show({slot.payload, packets, slot.arrival_ns});
}

void LiveEmulator::take(const CapturedFrame& frame) {
    if (frame.record.layout != camera_.layout()) {
        result_.end = DeviceLost{"the camera sends another region or pixel format"};
        return;
    }
    hold_missing(frame.record);
    result_.rate.add(frame.record);
    if (frame.record.status != FrameStatus::kComplete) return;
    to_light_.convert(frame.payload, light_);
    const std::int64_t arrival_ns = frame.record.host_monotonic_ns;
    expose({frame.payload, {}, arrival_ns});
    last_done_ns_ = monotonic_ns();
    if (result_.latencies.count() == 0) first_done_ns_ = last_done_ns_;
    const auto latency_us = static_cast<double>(last_done_ns_ - arrival_ns) * 1e-3;
    result_.latencies.add(latency_us);
    if (latency_us <= options_.late_after_slots * recorder_.emulator().setup().params.slot_us)
        return;
    ++result_.late_slots;
    if (result_.late.size() < kMaxListedFaults)
        result_.late.push_back({recorder_.emulator().stats().slots - 1, arrival_ns, latency_us});
}

FootageOrigin live_origin(const std::string& address, const LiveCamera& camera,
                          double black_level_dn, const std::function<void()>& check) {
    FootageOrigin origin{.name = camera.description().model};
    if (camera_kind(address).is_replay) {
        const std::string file(replayed_file(address));
        origin = origin_of(file, FootageOptions{}, check);
        if (!is_recording(file)) origin.pixel_format = camera.layout().format->name;
    } else {
        origin.recording = new_recording_name();
    }
    origin.black_level_dn = black_level_dn;
    return origin;
}

}  // namespace stipple
