#pragma once

#include <filesystem>

#include "apps/arguments/run_options.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// The recorder of a new stream `file`. Says on standard error what a run that was killed has left
/// of it. `setup` must outlive the recorder. \throws InputError, DeviceError as StreamRecorder.
[[nodiscard]] StreamRecorder open_stream_output(const std::filesystem::path& file,
                                                const RunOptions& run, const SensorSetup& setup,
                                                const FootageOrigin& origin);

}  // namespace stipple
