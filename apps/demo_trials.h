#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apps/arguments/run_options.h"
#include "apps/report/demo_report.h"
#include "core/flux_video.h"
#include "report/run_report.h"

namespace stipple {

/// Records and decodes `truth` in each way of the demo and leaves in `folder` the recordings, the
/// last way's video as `decoded/` (EXR) and `decoded.mp4`, and all ways side by side, for three
/// slots, as `side_by_side_1.png` ... The recordings and videos go into `report` too.
/// \throws Interrupted, InputError, DeviceError.
std::vector<TrialResult> run_trials(const FluxVideo& truth, const std::filesystem::path& folder,
                                    RunReport& report, const RunOptions& run);

}  // namespace stipple
