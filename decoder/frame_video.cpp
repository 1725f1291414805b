#include "decoder/frame_video.h"

#include "decoder/measurements.h"
#include "decoder/motion/frame_interpolation.h"

namespace stipple {

FluxVideo video_of_frames(const Measurements& measurements,
                          std::span<const FrameExposure> exposures, const FluxVideo& frames) {
    if (frames.slots() == measurements.slots) return frames;
    FluxVideo x = interpolate_frames(frames, centre_slots(exposures), measurements.slots);
    back_project_residual(measurements, exposures, frames, x);
    return x;
}

}  // namespace stipple
