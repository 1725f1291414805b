#pragma once

#include "core/flux_video.h"
#include "decoder/best/variance_stabilisation.h"
#include "decoder/conventional/frame_decoding.h"

namespace stipple {

/// Frames after 2 sqrt(x + d), d = dark_variance / per_light, whose noise has the standard
/// deviation `sigma` everywhere; three planes as luma and opponent colours.
struct StabilisedFrames {
    FluxVideo values;
    AnscombeParams scale;
    float sigma = 0;
};

[[nodiscard]] StabilisedFrames stabilised(const DeliveredFrames& frames);

/// The light of frames without noise: y^2 / 4 - d + per_light / 4. The last term corrects the mean
/// of square roots, which is below the square root of the mean.
[[nodiscard]] FluxVideo restored(const FluxVideo& values, AnscombeParams scale,
                                 const FrameNoise& noise);

}  // namespace stipple
