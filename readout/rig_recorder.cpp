#include "readout/rig_recorder.h"

#include <fmt/format.h>

#include <utility>

#include "core/error.h"
#include "readout/sensor_file.h"

namespace stipple {

RigRecorder::RigRecorder(const RigSensor& sensor, const SensorSetup& setup,
                         const std::filesystem::path& file, StreamRecorderOptions options)
    : sensor_(sensor),
      warp_(sensor.from_reference, setup.footage),
      recorder_(file, setup, std::move(options)) {}

void RigRecorder::expose(std::int64_t slot, std::span<const float> frame) {
    if (slot >= sensor_.phase_slots) recorder_.expose(warp_(frame));
}

void RigRecorder::finish(std::int64_t slots) {
    if (recorder_.emulator().stats().slots == 0)
        throw InputError(fmt::format("sensor \"{}\" of the rig", sensor_.name),
                         fmt::format("begins at slot {}, but the footage has {} slots",
                                     sensor_.phase_slots, slots));
    recorder_.finish();
}

}  // namespace stipple
