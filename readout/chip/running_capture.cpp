#include "readout/chip/running_capture.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "core/index.h"

namespace stipple {

RunningCapture::RunningCapture(CapturePlan plan, const StreamRecorderOptions& options,
                               const std::filesystem::path& file, OpenLight open_light)
    : plan_(std::move(plan)),
      setups_{plan_.setup},
      cost_(plan_.settings.timing, setups_.front().schedule.schedule, plan_.settings.window,
            plan_.settings.slot),
      recorder_(std::make_unique<StreamRecorder>(file, setups_.front(), options)),
      open_light_(std::move(open_light)),
      light_(open_light_()) {}

bool RunningCapture::stops() const {
    return stops_ || (plan_.settings.slots != 0 && counters_.slots == plan_.settings.slots);
}

std::int64_t RunningCapture::scan_end() const {
    return begin_ + slot_.scan_begin + slot_.counts.readout_clocks;
}

void RunningCapture::swap(std::int64_t clock, std::int64_t fill_clocks,
                          std::function<SensorSetup(std::int64_t)> schedule_from) {
    // Tables are filled from the clock after the write on, but not before slot 0 has begun.
    const std::int64_t from = std::max(clock + 1, begin_ + 1) + fill_clocks;
    swap_ = {.from = from, .schedule_from = std::move(schedule_from)};
    is_taken_ = false;
}

void RunningCapture::advance(std::int64_t clock) {
    while (!is_over_) {
        take_swap(clock);
        if (next_begin_ >= clock) break;
        begin_next();
    }
    for (; !packed_.empty() && packed_.front().clock < clock; packed_.pop_front()) {
        const ChipCounters& more = packed_.front().counts;
        counters_.overruns += more.overruns;
        counters_.dropped += more.dropped;
        counters_.packets += more.packets;
        counters_.samples += more.samples;
    }
    if (is_over_ && idle_ < clock) end();
}

/// In a clock before `clock` in which no slot begins.
void RunningCapture::take_swap(std::int64_t clock) {
    if (!swap_ || is_taken_ || counters_.slots == 0) return;
    const std::int64_t at = std::max(swap_->from, begin_ + slot_.begin + 1);
    if (at >= std::min(next_begin_, clock)) return;
    try {
        setups_.push_back(swap_->schedule_from(cost_.slots()));
        check_switch(setups_.front(), setups_.back(), cost_.slots());
    } catch (const InputError& e) {
        problem_ = e.what();
        stops_ = true;
        swap_.reset();
        return;
    }
    const ExposureSchedule& next = setups_.back().schedule.schedule;
    slot_ = cost_.before_switch(next, at + 1 - begin_);
    cost_.switch_to(next, at + 1 - begin_);
    next_begin_ = begin_ + cost_.clocks();
    is_taken_ = true;
}

/// The slot that has ended gives its samples, and the next one begins.
void RunningCapture::begin_next() {
    if (counters_.slots > 0) expose();
    if (is_taken_ && !stops()) make_swap();
    if (stops()) {
        is_over_ = true;
        idle_ = std::max(next_begin_ + 1, counters_.slots > 0 ? scan_end() : 0);
        return;
    }
    slot_ = cost_.add_next();
    ++counters_.slots;
    next_begin_ = begin_ + cost_.clocks();
    const ReadoutTiming& timing = plan_.settings.timing;
    if (slot_.counts.rows > 0 && timing.rot_clocks + timing.adc_clocks + slot_.settle_clocks == 0)
        has_no_time_ = true;
}

void RunningCapture::make_swap() {
    try {
        recorder_->switch_to(setups_.back());
    } catch (const InputError& e) {  // an exposure would become too long for a stream
        problem_ = e.what();
        stops_ = true;
        return;
    }
    counters_.swap_slot = counters_.slots;
    swapped_ = true;
    is_taken_ = false;
    swap_.reset();
}

void RunningCapture::expose() {
    const CaptureSettings& settings = plan_.settings;
    SlotCost slot = slot_;
    slot.overrun = slot.end_row < settings.window.rows ||
                   (settings.budget_clocks > 0 && slot.clocks > settings.budget_clocks);
    Packed packed{.clock = std::max(next_begin_, scan_end()), .counts = {}};
    for (const SamplePacket& packet : recorder_->expose(next_frame(), slot)) {
        ++packed.counts.packets;
        packed.counts.samples += static_cast<std::uint32_t>(packet.dn.size());
        packed.counts.overruns += (packet.flags & SamplePacket::kOverrun) != 0 ? 1U : 0U;
        packed.counts.dropped += (packet.flags & SamplePacket::kDropped) != 0 ? 1U : 0U;
    }
    packed_.push_back(packed);
}

/// The next frame of the region.
std::span<const float> RunningCapture::next_frame() {
    std::span<const float> frame = light_();
    if (frame.empty()) {
        light_ = open_light_();
        frame = light_();
    }
    if (frame.empty()) throw InputError("footage", "has no frame");
    const FrameShape& from = plan_.light;
    const FrameShape& to = plan_.setup.footage;
    if (from == to) return frame;
    region_.clear();
    for (int plane = 0; plane < to.planes; ++plane)
        for (int row = 0; row < to.rows; ++row) {
            const auto line = frame.subspan(
                (index(plane) * index(from.rows) + index(row)) * index(from.cols), index(to.cols));
            region_.insert(region_.end(), line.begin(), line.end());
        }
    return region_;
}

void RunningCapture::end() {
    if (ended_) return;
    ended_ = true;
    swap_.reset();
    if (counters_.slots > 0) recorder_->finish();
    recorder_.reset();
}

}  // namespace stipple
