#pragma once

#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "capture/camera.h"
#include "capture/capture_session.h"

namespace stipple {

/// The address and the settings of a camera.
struct CameraArguments {
    std::string address;
    std::string config;                 ///< file with `Feature = value` lines; empty: none
    std::vector<std::string> settings;  ///< "Feature=value", replaces that of the file
    CameraBuffers buffers;
};

/// `ADDRESS`, `--config` and `--buffers`; `--set camera.FEATURE=VALUE` is the command's.
void add_camera_arguments(Command& command, CameraArguments& arguments);

/// `--config` and `--buffers` alone.
void add_camera_options(Command& command, CameraArguments& arguments);

/// The settings in the order of the file, then of the command line. \throws InputError.
[[nodiscard]] CameraSettings camera_settings(const CameraArguments& arguments);

/// Opens the camera, which must send images. A signal ends the waiting for it: Interrupted.
/// \throws InputError.
[[nodiscard]] CaptureSession::Opener image_camera_opener(const CameraArguments& arguments);

/// Whether the address is that of a recording or footage.
[[nodiscard]] bool is_replay(const CameraArguments& arguments);

/// `--incomplete`.
void add_incomplete_argument(Command& command, IncompletePolicy& policy);

/// `--fail-on-loss`.
void add_loss_argument(Command& command, bool& fails_on_loss);

/// `--stall` and `--no-reconnect`.
void add_session_arguments(Command& command, SessionOptions& options);

/// \throws UsageError for an option of these that has no effect on a replay.
void check_session_arguments(const Command& command, const CameraArguments& camera);

/// `--frames` and `--seconds`.
void add_capture_limits(Command& command, CaptureLimits& limits);

}  // namespace stipple
