#pragma once

#include <string>
#include <vector>

#include "apps/arguments/sensor.h"
#include "apps/part_of_work.h"
#include "readout/sensor_file.h"
#include "session/emulation_source.h"

namespace stipple {

/// The arguments of `stipple emulate`.
struct EmulateArguments {
    EmulationSource source;
    std::string output;
    std::string truth;  ///< empty: none
    WaveformOptions waveform;
    SensorChoice sensor;
    std::string calibration;                ///< file of the chip, for the decoder; empty: none
    Shard part;                             ///< of the pieces of the stream
    std::string rig;                        ///< name or file; empty: one sensor
    std::vector<std::string> rig_settings;  ///< "key=value", laid over the rig's file
};

/// The footage of an emulation and the sensor that it goes through. Warns on standard error of what
/// does not fit together.
class EmulationInput {
  public:
    /// \throws InputError. `arguments` must outlive it.
    explicit EmulationInput(const EmulateArguments& arguments);

    [[nodiscard]] const ReadAhead& footage() const { return footage_; }
    [[nodiscard]] const SensorSetup& setup() const { return setup_; }
    [[nodiscard]] ResampledFootage& slots() { return slots_; }

  private:
    ReadAhead footage_;
    SensorSetup setup_;
    ResampledFootage slots_;
};

}  // namespace stipple
