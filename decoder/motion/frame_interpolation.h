#pragma once

#include <span>

#include "core/flux_video.h"

namespace stipple {

/// The video of `slots` slots from frames that show the scene at the times `centre_slots`, which
/// increase. A slot between two frames is computed from both, moved along straight lines in space
/// and time. Candidates for the motion of a pixel are the motion estimated in either frame and
/// followed to the pixel, the motion of nearby pixels, and no motion; the candidate with the
/// smallest difference between the frames around the pixel is taken. The first frame is held before
/// its time, and the last one after its time. The same bits for any thread count. Precondition: at
/// least one frame.
[[nodiscard]] FluxVideo interpolate_frames(const FluxVideo& frames,
                                           std::span<const float> centre_slots, int slots);

}  // namespace stipple
