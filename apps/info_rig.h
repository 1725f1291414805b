#pragma once

#include <string>

#include "apps/arguments/run_options.h"

namespace stipple {

/// `stipple info` of the folder of a rig. Reads all streams. \throws InputError as open_rig_folder,
/// or if a stream is damaged.
void info_rig(const std::string& folder, const RunOptions& run);

/// `stipple info` of the file of a rig, or of a name in `stipple list rigs`. \throws InputError as
/// read_rig.
void info_rig_file(const std::string& name, const RunOptions& run);

}  // namespace stipple
