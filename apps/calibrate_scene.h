#pragma once

#include <string>

#include "apps/arguments/command_line.h"
#include "apps/arguments/run_options.h"
#include "calibration/chip_calibration.h"

namespace stipple {

/// Arguments of `stipple calibrate --scene`.
struct SceneArguments {
    std::string stream;  ///< empty: not given
    std::string method = "best";
    double prnu = 0;  ///< 0: as the stream tells
};

void add_scene_arguments(Command& command, SceneArguments& arguments);

/// The gains of a chip from a stream of any scene. \throws InputError as `scene_calibration`, and
/// if nothing tells the PRNU; Interrupted.
[[nodiscard]] ChipCalibration calibrate_by_scene(const SceneArguments& arguments,
                                                 const RunOptions& run);

}  // namespace stipple
