#pragma once

#include "apps/camera_arguments.h"
#include "capture/capture_session.h"

namespace CLI {
class App;
}

namespace stipple {

/// `--incomplete`, `--stall` and `--no-reconnect`.
void add_session_arguments(CLI::App& command, SessionOptions& options);

/// \throws CLI::ValidationError for those that do nothing with a replay.
void check_session_arguments(const CLI::App& command, const CameraArguments& camera);

}  // namespace stipple
