#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/arguments/run_options.h"
#include "io/pending_output.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"

namespace stipple {

using Switches = std::vector<std::string>;

/// The recorder of a new stream `file`, with the provenance of `setup`, `origin` and the `switches`
/// of the command line; nothing if the sensor never switches. Reports leftovers of a killed run on
/// standard error. `setup` must outlive the recorder. \throws InputError, DeviceError as
/// StreamRecorder.
[[nodiscard]] StreamRecorder open_stream_output(const std::filesystem::path& file,
                                                const RunOptions& run, const SensorSetup& setup,
                                                const FootageOrigin& origin,
                                                const std::optional<Switches>& switches = {});

struct SensorSetup;

/// A copy of a calibration file that goes with a new stream, if the file is not beside it already:
/// calibration_beside finds it.
class AttachedCalibration {
  public:
    /// \throws InputError as read_calibration for the stream of `setup`, and as PendingOutput.
    AttachedCalibration(const std::string& file, std::filesystem::path stream,
                        const SensorSetup& setup, const RunOptions& run);
    /// Puts it in place. \throws DeviceError.
    void write();

  private:
    std::string bytes_;
    std::optional<PendingOutput> output_;
};

}  // namespace stipple
