#include "decoder/conventional/stabilised_frames.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace stipple {

StabilisedFrames stabilised(const DeliveredFrames& frames) {
    constexpr float kMaxOffset = 1e3F;  // flux; where noise is larger than that, light is not seen
    const FluxVideo& light = frames.light;
    const float offset = std::min(frames.noise.dark_variance / frames.noise.per_light, kMaxOffset);
    StabilisedFrames result{FluxVideo(light.slots(), light.shape()),
                            AnscombeParams{.offset = offset, .min_light = -offset},
                            std::sqrt(frames.noise.per_light)};
    parallel_for(0, light.slots(), [&](int frame) {
        stabilise_variance(light.frame(frame), light.shape().planes, result.scale,
                           result.values.frame(frame));
    });
    return result;
}

FluxVideo restored(const FluxVideo& values, AnscombeParams scale, const FrameNoise& noise) {
    FluxVideo light(values.slots(), values.shape());
    parallel_for(0, values.slots(), [&](int frame) {
        restore_light(values.frame(frame), values.shape().planes, scale, light.frame(frame));
        for (float& x : light.frame(frame)) x += noise.per_light / 4;
    });
    return light;
}

}  // namespace stipple
