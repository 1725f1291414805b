#include "decoder/stabilised_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace stipple {
namespace {

constexpr float kByRoot2 = 0.707106781F;
constexpr float kByRoot3 = 0.577350269F;
constexpr float kByRoot6 = 0.408248290F;

void to_opponent(std::span<float> frame) {
    const std::size_t pixels = frame.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float red = frame[i];
        const float green = frame[pixels + i];
        const float blue = frame[2 * pixels + i];
        frame[i] = kByRoot3 * (red + green + blue);
        frame[pixels + i] = kByRoot2 * (red - blue);
        frame[2 * pixels + i] = kByRoot6 * (red - 2 * green + blue);
    }
}

void from_opponent(std::span<float> frame) {
    const std::size_t pixels = frame.size() / 3;
    for (std::size_t i = 0; i < pixels; ++i) {
        const float sum = kByRoot3 * frame[i];
        const float red_blue = kByRoot2 * frame[pixels + i];
        const float green = kByRoot6 * frame[2 * pixels + i];
        frame[i] = sum + red_blue + green;
        frame[pixels + i] = sum - 2 * green;
        frame[2 * pixels + i] = sum - red_blue + green;
    }
}

}  // namespace

void stabilise(std::span<const float> light, int planes, float offset,
               std::span<float> stabilised) {
    assert(stabilised.size() == light.size());
    for (std::size_t i = 0; i < light.size(); ++i)
        stabilised[i] = 2 * std::sqrt(std::max(light[i], 0.0F) + offset);
    if (planes == 3) to_opponent(stabilised);
}

void restore_light(std::span<const float> stabilised, int planes, float offset,
                   std::span<float> light) {
    assert(stabilised.size() == light.size());
    std::ranges::copy(stabilised, light.begin());
    if (planes == 3) from_opponent(light);
    for (float& x : light) {
        const float root = std::max(x, 0.0F);
        x = std::max(root * root / 4 - offset, 0.0F);
    }
}

}  // namespace stipple
