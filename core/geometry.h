#pragma once

#include <cstddef>

namespace stipple {

/// Size of one frame. A site is one photodiode: a pixel of a mono sensor, or one of the stacked
/// colour planes of a pixel.
struct FrameShape {
    int rows = 0;
    int cols = 0;
    int planes = 1;  ///< 1 mono, 3 stacked RGB

    [[nodiscard]] std::size_t pixels() const {
        return static_cast<std::size_t>(rows) * static_cast<std::size_t>(cols);
    }
    [[nodiscard]] std::size_t sites() const { return pixels() * static_cast<std::size_t>(planes); }
    bool operator==(const FrameShape&) const = default;
};

}  // namespace stipple
