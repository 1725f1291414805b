#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "apps/arguments/run_options.h"
#include "io/pending_output.h"

namespace stipple {

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
