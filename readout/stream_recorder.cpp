#include "readout/stream_recorder.h"

#include <utility>

namespace stipple {
namespace {

StreamHeader header_of(const SensorSetup& setup, StreamRecorderOptions& options) {
    StreamHeader header = stream_header_of(setup, std::move(options.provenance));
    header.may_switch = options.may_switch;
    return header;
}

}  // namespace

StreamRecorder::StreamRecorder(const std::filesystem::path& file, const SensorSetup& setup,
                               StreamRecorderOptions options)
    : output_(file, options.force),
      emulator_(std::make_unique<Emulator>(setup)),
      writer_(output_.partial(), header_of(setup, options), output_.final_path().string()),
      holds_back_(options.may_switch && emulator_->readout_cost() != nullptr) {}

StreamRecorder::~StreamRecorder() = default;

void StreamRecorder::write_waiting() {
    if (waiting_) writer_.write(*waiting_);
    waiting_.reset();
}

std::span<const SamplePacket> StreamRecorder::written(std::span<const SamplePacket> packets) {
    write_waiting();
    for (const SamplePacket& packet : packets) {
        if (holds_back_)
            waiting_ = packet;  // the only one, as no rows are dropped
        else
            writer_.write(packet);
        samples_ += packet.dn.size();
    }
    return packets;
}

ScheduleSwitch StreamRecorder::switch_to(const SensorSetup& next) {
    check_switch(emulator_->setup(), next, emulator_->stats().slots);
    if (waiting_) {
        const SlotCost slot = emulator_->readout_cost()->before_switch(next.schedule.schedule);
        waiting_->flags = static_cast<std::uint8_t>((waiting_->flags & ~SamplePacket::kOverrun) |
                                                    (slot.overrun ? SamplePacket::kOverrun : 0));
    }
    write_waiting();
    const ScheduleSwitch& written = writer_.switch_schedule(switch_of(next));
    emulator_->switch_to(next);
    return written;
}

std::span<const SamplePacket> StreamRecorder::expose(std::span<const float> frame) {
    return written(emulator_->expose(frame));
}

std::span<const SamplePacket> StreamRecorder::expose(std::span<const float> frame,
                                                     const SlotCost& slot) {
    return written(emulator_->expose(frame, slot));
}

std::span<const SamplePacket> StreamRecorder::expose_unread(std::span<const float> frame) {
    return written({&emulator_->expose_unread(frame), 1});
}

void StreamRecorder::finish() {
    write_waiting();
    writer_.finish();
    output_.commit();
}

bool StreamRecorder::keep() {
    if (output_.kept()) return false;
    output_.commit();
    return true;
}

std::uint64_t StreamRecorder::payload_bits() const {
    return samples() * static_cast<std::uint64_t>(emulator().setup().params.bit_depth);
}

double StreamRecorder::compression_ratio() const {
    const double light_values = static_cast<double>(emulator().stats().slots) *
                                static_cast<double>(emulator().setup().shape.sites());
    return light_values / static_cast<double>(samples());
}

double StreamRecorder::saturated_fraction() const {
    return static_cast<double>(emulator().stats().saturated_samples) /
           static_cast<double>(emulator().stats().samples);
}

double StreamRecorder::zero_fraction() const {
    return static_cast<double>(emulator().stats().zero_samples) /
           static_cast<double>(emulator().stats().samples);
}

}  // namespace stipple
