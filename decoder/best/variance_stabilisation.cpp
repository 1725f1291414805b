#include "decoder/best/variance_stabilisation.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "decoder/opponent_planes.h"

namespace stipple {
namespace {

PlaneTriple planes_of(std::span<float> frame) {
    const std::size_t pixels = frame.size() / 3;
    return {
        .first = frame.data(), .second = frame.data() + pixels, .third = frame.data() + 2 * pixels};
}

}  // namespace

void stabilise_variance(std::span<const float> light, int planes, AnscombeParams scale,
                        std::span<float> stabilised) {
    assert(stabilised.size() == light.size());
    for (std::size_t i = 0; i < light.size(); ++i)
        stabilised[i] = 2 * std::sqrt(std::max(light[i], scale.min_light) + scale.offset);
    if (planes == 3) to_opponents(light.size() / 3, planes_of(stabilised));
}

void restore_light(std::span<const float> stabilised, int planes, AnscombeParams scale,
                   std::span<float> light) {
    assert(stabilised.size() == light.size());
    std::ranges::copy(stabilised, light.begin());
    if (planes == 3) from_opponents(light.size() / 3, planes_of(light));
    for (float& x : light) {
        const float root = std::max(x, 0.0F);
        x = std::max(root * root / 4 - scale.offset, scale.min_light);
    }
}

}  // namespace stipple
