#pragma once

#include <span>

namespace stipple {

// Light on a scale on which its noise is the same everywhere: 2 sqrt(x + offset) of each plane
// (Anscombe 1948), then, of three planes, luma and two opponents (opponent_planes.h). Frames have
// the order (plane, row, col).

/// Light below `least` counts as that. Precondition: 0 <= -least <= offset.
struct RootScale {
    float offset;
    float least = 0;
};

void stabilise_variance(std::span<const float> light, int planes, RootScale scale,
                        std::span<float> stabilised);

/// The inverse; never below `least`.
void restore_light(std::span<const float> stabilised, int planes, RootScale scale,
                   std::span<float> light);

}  // namespace stipple
