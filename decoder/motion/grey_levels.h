#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

/// What optical flow looks at: 255 sqrt(luminance) of a slot, order (row, col). The square root,
/// unlike a power of 1/2.2, is the same bits everywhere.
[[nodiscard]] std::vector<std::uint8_t> grey_levels(const FluxVideo& video, int slot);

}  // namespace stipple
