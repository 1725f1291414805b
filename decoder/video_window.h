#pragma once

#include <cstddef>
#include <cstdint>

#include "core/geometry.h"

namespace stipple {

/// A box of voxels of a video: `slots` slots from `first_slot`, and the pixels from (first_row,
/// first_col); `shape` is the size of one of its frames.
struct VideoWindow {
    std::int64_t first_slot = 0;
    int slots = 0;
    int first_row = 0;
    int first_col = 0;
    FrameShape shape;

    [[nodiscard]] std::size_t voxels() const {
        return static_cast<std::size_t>(slots) * shape.sites();
    }
};

}  // namespace stipple
