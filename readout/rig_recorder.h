#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "readout/light_warp.h"
#include "readout/rig.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// A sensor of a rig that writes its stream: it sees the light through its homography, from its
/// first slot on.
class RigRecorder {
  public:
    /// `sensor`, and `setup`, which set_up_rig made of it, must outlive the recorder.
    /// \throws InputError, DeviceError as StreamRecorder.
    RigRecorder(const RigSensor& sensor, const SensorSetup& setup,
                const std::filesystem::path& file, StreamRecorderOptions options = {});

    /// Exposes the sensor to slot `slot` of the footage, which follows the slot before, as
    /// StreamRecorder does. \throws DeviceError.
    void expose(std::int64_t slot, std::span<const float> frame);
    /// Puts the file in place. \throws InputError if the footage of `slots` has ended before the
    /// first slot of the sensor, DeviceError.
    void finish(std::int64_t slots);

    [[nodiscard]] const RigSensor& sensor() const { return sensor_; }
    [[nodiscard]] const StreamRecorder& recorder() const { return recorder_; }

  private:
    const RigSensor& sensor_;
    LightWarp warp_;
    StreamRecorder recorder_;
};

}  // namespace stipple
