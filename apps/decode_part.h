#pragma once

#include "apps/arguments/run_options.h"
#include "apps/decode_file.h"

namespace stipple {

/// Decodes the windows of `arguments.part` that the folder `arguments.output` lacks (with `force`
/// all of the part). The parts have equal numbers of windows, except for one.
/// \throws InputError, DeviceError, Interrupted; complete windows are kept.
void decode_part(const DecodeArguments& arguments, const RunOptions& run);

}  // namespace stipple
