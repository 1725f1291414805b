#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

/// Input of the optical flow: 255 sqrt(luminance) of a slot, order (row, col). The square root
/// gives the same bits everywhere; a power of 1/2.2 does not.
[[nodiscard]] std::vector<std::uint8_t> grey_levels(const FluxVideo& video, int slot);

}  // namespace stipple
