#include "decoder/pixel_transforms.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stipple {
namespace {

constexpr float kRoot2 = 0.70710678F;  // 1 / sqrt(2)
constexpr float kRoot3 = 0.57735027F;
constexpr float kRoot6 = 0.40824829F;

PlaneTriple planes_of(std::span<float> frame) {
    const std::size_t pixels = frame.size() / 3;
    return {
        .first = frame.data(), .second = frame.data() + pixels, .third = frame.data() + 2 * pixels};
}

}  // namespace

void to_opponents(std::size_t count, const PlaneTriple& planes) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        const float red = planes.first[i];
        const float green = planes.second[i];
        const float blue = planes.third[i];
        planes.first[i] = (red + green + blue) * kRoot3;
        planes.second[i] = (red - blue) * kRoot2;
        planes.third[i] = (red - 2 * green + blue) * kRoot6;
    }
}

void from_opponents(std::size_t count, const PlaneTriple& planes) noexcept {
    for (std::size_t i = 0; i < count; ++i) {
        const float luma = planes.first[i] * kRoot3;
        const float red_blue = planes.second[i] * kRoot2;
        const float green = planes.third[i] * kRoot6;
        planes.first[i] = luma + red_blue + green;
        planes.second[i] = luma - 2 * green;
        planes.third[i] = luma - red_blue + green;
    }
}

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
