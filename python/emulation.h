#pragma once

#include <pybind11/pytypes.h>

#include <string>

#include "readout/stream_recorder.h"
#include "readout/timing/overrun_policy.h"

namespace stipple::python {

/// What was emulated: the keys of "emulate" in docs/outputs.md, without its speed.
[[nodiscard]] pybind11::dict figures_of(const StreamRecorder& recorder);

/// \throws InputError for another name than "stretch" and "drop".
[[nodiscard]] OverrunPolicy overrun_policy(const std::string& name);

}  // namespace stipple::python
