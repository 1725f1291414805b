#pragma once

#include <span>
#include <string>

#include "io/pixel_format.h"

namespace stipple {

/// What of a frame of light a pixel format cannot hold, in which 1.0 is full scale; empty if it
/// holds it all. `name` is the footage's.
[[nodiscard]] std::string clipping_text(const std::string& name, std::span<const float> light,
                                        const PixelFormat& format);

}  // namespace stipple
