#include "session/decode_session.h"

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "decoder/measurements.h"

namespace stipple {
namespace {

RigFolder alone(StreamReader stream) {
    RigFolder input;
    input.rig.sensors.resize(1);
    input.readers.push_back(std::move(stream));
    return input;
}

RigFolder opened(const std::filesystem::path& source, ReadPolicy policy) {
    return is_rig_folder(source) ? open_rig_folder(source, policy)
                                 : alone(StreamReader(source, policy));
}

}  // namespace

DecodeSession::DecodeSession(const std::filesystem::path& source, DecodeSetup setup,
                             const CalibrationChoice& calibration, ReadPolicy policy)
    : DecodeSession(opened(source, policy), std::move(setup), calibration) {}

DecodeSession::DecodeSession(StreamReader stream, DecodeSetup setup,
                             const CalibrationChoice& calibration)
    : DecodeSession(alone(std::move(stream)), std::move(setup), calibration) {}

DecodeSession::DecodeSession(RigFolder rig, DecodeSetup setup, const CalibrationChoice& calibration)
    : input_(std::move(rig)), setup_(std::move(setup)) {
    for (StreamReader& stream : input_.readers)
        if (Message warning = calibrate(stream, calibration); !warning.empty())
            warnings_.push_back(std::move(warning));
}

FrameShape DecodeSession::shape() const {
    return decoded_shape(streams().front().header());
}

std::optional<std::int64_t> DecodeSession::frames() const {
    auto frames = streams().front().slots();
    if (end_) frames = std::min(frames.value_or(*end_), *end_);
    if (frames) *frames = std::max<std::int64_t>(*frames - setup_.options.first_slot, 0);
    return frames;
}

std::optional<std::int64_t> DecodeSession::computed_slots() const {
    const auto slots = streams().front().slots();
    if (!slots) return {};
    return stipple::computed_slots(std::min(end_.value_or(*slots), *slots), *slots) -
           setup_.options.first_slot;
}

DecodeCost DecodeSession::expected_cost(std::int64_t computed_slots) {
    return stipple::expected_cost(input_.streams(), setup_.options.method, computed_slots);
}

DecodeReport DecodeSession::run(const FrameSink& sink, const ProgressCallback& progress) {
    bool stopped = false;
    const DecodeReport report = decode_rig(
        input_.streams(), setup_.options,
        [&](std::int64_t slot, std::span<const float> frame) {
            stopped = !sink(slot, frame);
            return !stopped && slot + 1 != end_;
        },
        [&](double slots) {
            stopped = stopped || !progress(slots);
            return !stopped;
        });
    // What ends the wait for a growing stream may be what stops the decoding.
    if (report.slots == 0 && !stopped && progress(0))
        throw InputError(streams().front().name(), "holds no slot to decode");
    return report;
}

}  // namespace stipple
