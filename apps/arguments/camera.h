#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "capture/camera.h"
#include "capture/capture_limits.h"
#include "capture/capture_session.h"

namespace stipple {

/// Which camera, and how it is set up.
struct CameraArguments {
    std::string address;
    std::string config;                 ///< file with `Feature = value` lines; empty: none
    std::vector<std::string> settings;  ///< "Feature=value", laid over the file's
    CameraBuffers buffers;
};

/// `ADDRESS`, `--config` and `--buffers`; `--set camera.FEATURE=VALUE` is the command's.
void add_camera_arguments(Command& command, CameraArguments& arguments);

/// The settings in the order of the file, then of the command line. \throws InputError.
[[nodiscard]] CameraSettings camera_settings(const CameraArguments& arguments);

/// Opens the camera for its images. \throws InputError, DeviceError as open_camera; InputError if
/// what it sends is a coded stream, whose payloads only look like images.
[[nodiscard]] std::unique_ptr<Camera> open_image_camera(const CameraArguments& arguments,
                                                        const CameraSettings& settings);

/// Whether the address is that of a recording or footage.
[[nodiscard]] bool is_replay(const CameraArguments& arguments);

/// What a session may take for a fault: a replay has an end, and pauses where the recording has
/// them.
[[nodiscard]] SessionOptions session_options(const CameraArguments& arguments,
                                             SessionOptions options);

/// `--incomplete`.
void add_incomplete_argument(Command& command, IncompletePolicy& policy);

/// `--stall` and `--no-reconnect`.
void add_session_arguments(Command& command, SessionOptions& options);

/// \throws UsageError for those that do nothing with a replay.
void check_session_arguments(const Command& command, const CameraArguments& camera);

/// `--frames` and `--seconds`.
void add_capture_limits(Command& command, CaptureLimits& limits);

}  // namespace stipple
