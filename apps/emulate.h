#pragma once

#include <string>
#include <vector>

#include "apps/arguments/run_options.h"
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
    std::vector<std::string> switches;      ///< of the sensor, as SensorSwitches reads them
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

/// Emulates the pieces of `arguments.part` that the folder `arguments.output` lacks (with `force`
/// all of the part). \throws InputError, DeviceError, Interrupted; complete pieces are kept.
void emulate_part(const EmulateArguments& arguments, const RunOptions& run);

/// `stipple emulate --rig`: a folder with the stream of each sensor and the rig (docs/rig.md).
/// \throws InputError, DeviceError, Interrupted.
void emulate_rig(const EmulateArguments& arguments, const RunOptions& run);

}  // namespace stipple
