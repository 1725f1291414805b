#include "readout/stream_recorder.h"

#include <utility>

#include "readout/emulator.h"
#include "readout/light_throughput.h"

namespace stipple {

StreamRecorder::StreamRecorder(const std::filesystem::path& file, const SensorSetup& setup,
                               StreamRecorderOptions options)
    : output_(file, options.force),
      emulator_(std::make_unique<Emulator>(setup)),
      writer_(output_.partial(), stream_header_of(setup, std::move(options.provenance)),
              output_.final_path().string()) {}

StreamRecorder::~StreamRecorder() = default;

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

const SensorSetup& StreamRecorder::setup() const {
    return emulator_->setup();
}

const ReadoutStats& StreamRecorder::stats() const {
    return emulator_->stats();
}

std::uint64_t StreamRecorder::payload_bits() const {
    return samples() * static_cast<std::uint64_t>(setup().params.bit_depth);
}

double StreamRecorder::compression_ratio() const {
    const double light_values =
        static_cast<double>(stats().slots) * static_cast<double>(setup().shape.sites());
    return light_values / static_cast<double>(samples());
}

double StreamRecorder::saturated_fraction() const {
    return static_cast<double>(stats().saturated_samples) / static_cast<double>(stats().samples);
}

double StreamRecorder::zero_fraction() const {
    return static_cast<double>(stats().zero_samples) / static_cast<double>(stats().samples);
}

double StreamRecorder::light_throughput() const {
    return stipple::light_throughput(setup().schedule.schedule, emulator_->filters(),
                                     setup().shape);
}

double StreamRecorder::light_read() const {
    return emulator_->light_read();
}

ReadoutCost* StreamRecorder::readout_cost() {
    return emulator_->readout_cost();
}

const ReadoutCost* StreamRecorder::readout_cost() const {
    return emulator_->readout_cost();
}

}  // namespace stipple
