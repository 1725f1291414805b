#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/geometry.h"

namespace stipple {

/// Light that is displayed as white; brighter light is clipped.
inline constexpr float kWhiteLight = 4.0F;

/// Display value 0..255 of linear light, for videos and images for viewing: Reinhard's global curve
/// with a white point, x (1 + x / w^2) / (1 + x), w = kWhiteLight, then the power 1/2.2. Light 0.18
/// becomes 109, 1 becomes 191, 2 becomes 224. NaN and negative light are black. Source: Reinhard et
/// al., "Photographic tone reproduction for digital images", 2002, Eq. 4.
[[nodiscard]] inline std::uint8_t tone_mapped(float light) {
    if (!(light > 0.0F)) return 0;
    const float x = std::min(light, kWhiteLight);
    const float compressed = x * (1.0F + x / (kWhiteLight * kWhiteLight)) / (1.0F + x);
    return static_cast<std::uint8_t>(std::lround(255.0F * std::pow(compressed, 1.0F / 2.2F)));
}

/// A frame (plane, row, col) as interleaved 8-bit pixels: grey, or red, green, blue.
/// Precondition: both hold shape.sites() values.
inline void tone_map_frame(std::span<const float> frame, FrameShape shape,
                           std::span<std::uint8_t> pixels) {
    const auto planes = static_cast<std::size_t>(shape.planes);
    for (std::size_t plane = 0; plane < planes; ++plane)
        for (std::size_t i = 0; i < shape.pixels(); ++i)
            pixels[i * planes + plane] = tone_mapped(frame[plane * shape.pixels() + i]);
}

}  // namespace stipple
