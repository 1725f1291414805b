#pragma once

#include <span>

#include "core/flux_video.h"
#include "decoder/frame_exposures.h"

namespace stipple {

/// The video of all slots from the frames of a conventional camera: interpolated along motion
/// between the centres of their exposures (frame_interpolation.h), then with what the frames lack
/// (frame_exposures.h). If each slot is a frame, the frames themselves. Precondition: at least one
/// frame.
[[nodiscard]] FluxVideo video_of_frames(const Measurements& measurements,
                                        std::span<const FrameExposure> exposures,
                                        const FluxVideo& frames);

}  // namespace stipple
