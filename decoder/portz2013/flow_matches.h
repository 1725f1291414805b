#pragma once

#include "core/progress.h"
#include "decoder/portz2013/patch_matches.h"

namespace stipple {

/// Follows each block of a grid along the TV-L1 flow (Zach et al. 2007, OpenCV's implementation)
/// between neighbouring slots, computed in both directions on the square root of luminance. Flows
/// are concatenated. A trajectory ends where the forward-backward check fails or the block would
/// leave the frame. Each position along it, rounded to pixels, is a match; the first match is the
/// block itself. Frames with less than `kMinMotionSide` rows or columns have no flow. The same bits
/// for any number of threads. Incomplete if `progress` has stopped it.
[[nodiscard]] MatchList find_flow_matches(const FluxVideo& video, const FlowMatchOptions& options,
                                          const ProgressCallback& progress);

}  // namespace stipple
