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
      writer_(output_.partial(), header_of(setup, options), output_.final_path().string()) {}

StreamRecorder::~StreamRecorder() = default;

ScheduleSwitch StreamRecorder::switch_to(const SensorSetup& next) {
    check_switch(emulator_->setup(), next, emulator_->stats().slots);
    const ScheduleSwitch& written = writer_.switch_schedule(switch_of(next));
    emulator_->switch_to(next);
    return written;
}

std::span<const SamplePacket> StreamRecorder::expose(std::span<const float> frame) {
    const auto packets = emulator_->expose(frame);
    for (const SamplePacket& packet : packets) {
        writer_.write(packet);
        samples_ += packet.dn.size();
    }
    return packets;
}

std::span<const SamplePacket> StreamRecorder::expose_unread(std::span<const float> frame) {
    const SamplePacket& packet = emulator_->expose_unread(frame);
    writer_.write(packet);
    return {&packet, 1};
}

void StreamRecorder::finish() {
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
