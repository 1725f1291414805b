#pragma once

#include "apps/arguments/run_options.h"
#include "apps/emulation_input.h"

namespace stipple {

/// Emulates the pieces of `arguments.part` that the folder `arguments.output` lacks (with `force`
/// all of the part). \throws InputError, DeviceError, Interrupted; complete pieces are kept.
void emulate_part(const EmulateArguments& arguments, const RunOptions& run);

/// `stipple emulate --rig`: a folder with the stream of each sensor and the rig (docs/rig.md).
/// \throws InputError, DeviceError, Interrupted.
void emulate_rig(const EmulateArguments& arguments, const RunOptions& run);

}  // namespace stipple
