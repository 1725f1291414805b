#include "decoder/motion/grey_levels.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/light.h"

namespace stipple {

std::vector<std::uint8_t> grey_levels(const FluxVideo& video, int slot) {
    std::span<const float> light = video.frame(slot);
    std::vector<float> luminance;
    if (video.shape().planes == 3) {
        luminance.resize(video.shape().pixels());
        reduce_to_luminance(light, luminance);
        light = luminance;
    }
    std::vector<std::uint8_t> levels(light.size());
    std::ranges::transform(light, levels.begin(), [](float value) {
        return static_cast<std::uint8_t>(255 * std::sqrt(std::clamp(value, 0.0F, 1.0F)) + 0.5F);
    });
    return levels;
}

}  // namespace stipple
