#pragma once

#include <span>

namespace stipple {

// Variance-stabilising transform: 2 sqrt(x + offset) of each plane (Anscombe 1948), after which
// noise has the same variance everywhere. Three planes are then transformed to luma and two
// opponents (opponent_planes.h). Frames have the order (plane, row, col).

/// Light below `min_light` is replaced by `min_light`. Precondition: 0 <= -min_light <= offset.
struct AnscombeParams {
    float offset;
    float min_light = 0;
};

void stabilise_variance(std::span<const float> light, int planes, AnscombeParams scale,
                        std::span<float> stabilised);

/// The inverse; the result is at least `min_light`.
void restore_light(std::span<const float> stabilised, int planes, AnscombeParams scale,
                   std::span<float> light);

}  // namespace stipple
