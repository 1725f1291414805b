#pragma once

#include <string>
#include <vector>

#include "capture/camera.h"

namespace CLI {
class App;
}

namespace stipple {

/// Which camera, and how it is set up.
struct CameraArguments {
    std::string address;
    std::string config;                 ///< file with `Feature = value` lines; empty: none
    std::vector<std::string> settings;  ///< "Feature=value", laid over the file's
    CameraBuffers buffers;
};

/// `ADDRESS`, `--config`, `--set` and `--buffers`.
void add_camera_arguments(CLI::App& command, CameraArguments& arguments);

/// The settings in the order of the file, then of the command line. \throws InputError.
[[nodiscard]] CameraSettings camera_settings(const CameraArguments& arguments);

}  // namespace stipple
