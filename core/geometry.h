#pragma once

#include <cstddef>
#include <cstdint>

namespace stipple {

/// Max rows, max columns and max sites of a frame, as in a sample stream (docs/stream_format.md).
inline constexpr int kMaxFrameSide = 65535;
inline constexpr std::uint64_t kMaxFrameSites = std::uint64_t{1} << 28U;

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
