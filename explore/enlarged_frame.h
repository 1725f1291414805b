#pragma once

#include <span>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// A frame of n times as many rows and columns, order (plane, row, col), by a sinc with the window
/// of Lanczos, of 6 x 6 pixels. Beyond the borders light is that of the nearest pixel; negative
/// light becomes 0. A linear interpolation of signals in light, without a model of scenes or noise.
[[nodiscard]] std::vector<float> enlarged_frame(std::span<const float> frame, FrameShape shape,
                                                int n);

}  // namespace stipple
