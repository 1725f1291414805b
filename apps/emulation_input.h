#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/footage.h"
#include "apps/arguments/sensor.h"
#include "apps/part_of_work.h"
#include "capture/recording/read_ahead.h"
#include "capture/recording/resampled_footage.h"
#include "readout/provenance.h"
#include "readout/sensor_file.h"

namespace stipple {

/// The arguments of `stipple emulate`.
struct EmulateArguments {
    std::string footage;
    std::string output;
    std::string truth;  ///< empty: none
    WaveformOptions waveform;
    FootageOptions reading;
    std::optional<Resampling> resampling;  ///< none: each frame is a slot
    SensorChoice sensor;
    std::string calibration;                ///< file of the chip, for the decoder; empty: none
    PartOfWork part;                        ///< of the pieces of the stream
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

/// The footage of `arguments` as slots of a sensor. \throws InputError as ResampledFootage.
[[nodiscard]] ResampledFootage slots_of(ReadAhead& footage, const EmulateArguments& arguments,
                                        double slot_us);

/// Reads the files of the footage. \throws InputError, Interrupted.
[[nodiscard]] FootageOrigin footage_origin(const EmulateArguments& arguments);

/// \throws InputError that the footage has no slot.
[[noreturn]] void refuse_short_footage(const std::string& footage);

}  // namespace stipple
