#pragma once

#include <span>
#include <string>

#include "io/pixel_format.h"

namespace stipple {

/// Fraction of the light of a frame that a pixel format clips, as a warning; empty if it clips
/// none. Light 1.0 is its full scale. `name` is that of the footage.
[[nodiscard]] std::string clipping_text(const std::string& name, std::span<const float> light,
                                        const PixelFormat& format);

}  // namespace stipple
