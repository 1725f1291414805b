#pragma once

#include <filesystem>

#include "apps/arguments/run_options.h"
#include "readout/provenance.h"
#include "readout/stream_recorder.h"

namespace stipple {

/// The recorder of a new stream `file`, with the provenance of `setup` and `origin`. Reports
/// leftovers of a killed run on standard error. `setup` must outlive the recorder. \throws
/// InputError, DeviceError as StreamRecorder.
[[nodiscard]] StreamRecorder open_stream_output(const std::filesystem::path& file,
                                                const RunOptions& run, const SensorSetup& setup,
                                                const FootageOrigin& origin);

}  // namespace stipple
