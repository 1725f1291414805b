#pragma once

#include <span>

#include "core/flux_video.h"

namespace stipple {

/// The video of `slots` slots from frames that show the scene at the times `centre_slots`, which
/// increase. A slot between two frames is made of both, moved to it along straight lines in space
/// and time: of the motion estimated at the pixel in either frame, followed to the pixel from
/// either side, that of pixels nearby, and rest, each pixel takes the one along which the frames
/// differ least around it. Before the first frame and after the last one that frame is held. The
/// same bits for any thread count. Precondition: at least one frame.
[[nodiscard]] FluxVideo interpolate_frames(const FluxVideo& frames,
                                           std::span<const float> centre_slots, int slots);

}  // namespace stipple
