#pragma once

#include <string>
#include <vector>

#include "apps/arguments/command_line.h"
#include "apps/arguments/run_options.h"
#include "apps/arguments/sensor.h"
#include "calibration/chip_calibration.h"
#include "core/geometry.h"
#include "readout/flat_field.h"
#include "study/calibration/field_series.h"

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

/// Arguments of `stipple calibrate` on series without light and of uniform light.
struct SeriesArguments {
    SensorChoice sensor = {.sensor = ""};
    FrameShape shape{.rows = 0, .cols = 0, .planes = 1};
    CalibrationImages emulated;
    int levels = -1;     ///< of `emulated`; -1: as the sensor needs
    std::string images;  ///< descriptor of images
    std::vector<std::string> dark;
    std::vector<std::string> flat;
};

void add_series_arguments(Command& command, SeriesArguments& arguments);

/// \throws UsageError for options of another source, or without what this one needs.
void check_series(const Command& command, const SeriesArguments& arguments);

/// \throws InputError as the readers of streams and images, and of a sensor; Interrupted.
[[nodiscard]] FieldSeries read_fields(const SeriesArguments& arguments, const RunOptions& run);

}  // namespace stipple
