#pragma once

#include "apps/camera_arguments.h"
#include "apps/command_line.h"
#include "capture/capture_session.h"

namespace stipple {

/// `--incomplete`.
void add_incomplete_argument(Command& command, IncompletePolicy& policy);

/// `--stall` and `--no-reconnect`.
void add_session_arguments(Command& command, SessionOptions& options);

/// \throws UsageError for those that do nothing with a replay.
void check_session_arguments(const Command& command, const CameraArguments& camera);

}  // namespace stipple
