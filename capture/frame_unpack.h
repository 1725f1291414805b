#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/frame_record.h"

namespace stipple {

/// The samples of a frame by row, column and plane; `samples` is resized. What `payload` is too
/// short for is 0.
void unpack_frame(const FrameLayout& layout, std::span<const std::uint8_t> payload,
                  std::vector<std::uint16_t>& samples);

}  // namespace stipple
