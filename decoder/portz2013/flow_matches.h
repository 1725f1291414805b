#pragma once

#include "decoder/portz2013/patch_matches.h"

namespace stipple {

/// Matches along motion, of blocks one slot long.
struct FlowMatchOptions {
    int block_px = 4;          ///< side of a block
    int radius_slots = 5;      ///< trajectories reach so far, forwards and backwards
    float consistency_px = 1;  ///< a trajectory ends where flow does not lead back this close
    float sigma = 0.05F;       ///< as in MatchSearch
};

/// Follows each block of a grid along the TV-L1 flow (Zach et al. 2007, the implementation of
/// OpenCV) between neighbouring slots, found both ways on the square root of luminance: flows are
/// concatenated, and end where the way back does not lead back or the block would leave the frame.
/// Each place on the way, to the nearest pixel, is a match; the block itself is the first. Frames
/// with less than `kMinMotionSide` rows or columns have no flow. The same bits for any number of
/// threads. Not complete if `progress` has stopped it.
[[nodiscard]] MatchList find_flow_matches(const FluxVideo& video, const FlowMatchOptions& options,
                                          const ProgressCallback& progress);

}  // namespace stipple
