#pragma once

#include "capture/capture_session.h"

namespace CLI {
class App;
}

namespace stipple {

/// `--incomplete`, `--stall` and `--no-reconnect`.
void add_session_arguments(CLI::App& command, SessionOptions& options);

}  // namespace stipple
