#pragma once

#include "apps/arguments/run_options.h"
#include "apps/emulation_input.h"

namespace stipple {

/// `stipple emulate --rig`: a folder with the stream of each sensor and the rig (docs/rig.md).
/// \throws InputError, DeviceError, Interrupted.
void emulate_rig(const EmulateArguments& arguments, const RunOptions& run);

}  // namespace stipple
