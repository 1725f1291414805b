#pragma once

#include <span>

#include "core/flux_video.h"

namespace stipple {

/// What the scene shows at `times` in slots, from frames that show it at the times `centre_slots`,
/// which increase. A time between two frames is computed from both, moved along straight lines in
/// space and time. Candidates for the motion of a pixel are the motion estimated in either frame
/// and followed to the pixel, the motion of nearby pixels, and no motion; the candidate with the
/// smallest difference between the frames around the pixel is taken. The first frame is held before
/// its time, and the last one after its time. The same bits for any thread count. Precondition: at
/// least one frame.
[[nodiscard]] FluxVideo interpolate_frames(const FluxVideo& frames,
                                           std::span<const float> centre_slots,
                                           std::span<const float> times);

/// The same at the times 0, 1 ... of `slots` slots.
[[nodiscard]] FluxVideo interpolate_frames(const FluxVideo& frames,
                                           std::span<const float> centre_slots, int slots);

/// Frames along motion at the times of their neighbours.
struct MovedFrames {
    FluxVideo previous;  ///< frame i - 1 at the time of frame i; frame 0 itself
    FluxVideo next;      ///< frame i + 1 at the time of frame i; the last frame itself
};

/// The motion of a pixel as in `interpolate_frames`. Precondition: at least one frame.
[[nodiscard]] MovedFrames move_frames(const FluxVideo& frames);

}  // namespace stipple
