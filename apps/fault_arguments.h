#pragma once

#include "apps/command_line.h"

namespace stipple {

struct GigeServerOptions;

/// What a served camera shall do wrong: `--fault-...`, for tests of clients.
void add_fault_arguments(Command& command, GigeServerOptions& options);

}  // namespace stipple
