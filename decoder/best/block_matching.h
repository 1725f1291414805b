#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/flux_video.h"
#include "core/geometry.h"
#include "decoder/motion/motion.h"

namespace stipple {

/// Side of the square blocks that are compared and filtered, in pixels, and blocks of a group.
inline constexpr int kBlockSide = 6;
inline constexpr int kGroupBlocks = 16;

/// Top left corners of the reference blocks of a frame: `offset` pixels back from every `step`th
/// pixel, moved into the frame where they reach beyond it. So every pixel is in a block.
/// Precondition: rows, cols >= kBlockSide; 1 <= step <= kBlockSide; 0 <= offset < step.
struct BlockGrid {
    FrameShape shape;
    int step = 5;
    int offset = 0;

    [[nodiscard]] int rows() const { return count(shape.rows); }
    [[nodiscard]] int cols() const { return count(shape.cols); }
    [[nodiscard]] int row(int i) const { return place(i, shape.rows); }
    [[nodiscard]] int col(int i) const { return place(i, shape.cols); }

  private:
    [[nodiscard]] int count(int side) const {
        return (side - kBlockSide + offset + step - 1) / step + 1;
    }
    [[nodiscard]] int place(int i, int side) const {
        const int at = i * step - offset;
        return at < 0 ? 0 : at < side - kBlockSide ? at : side - kBlockSide;
    }
};

/// Where similar blocks are looked for.
struct MatchingOptions {
    int slots = 10;       ///< before and after the slot of the reference
    int own_radius = 2;   ///< pixels around the reference, in its own slot
    int path_radius = 1;  ///< pixels around where motion has taken it, in the other slots
};

/// A block of a group is at most so many rows from its reference, wherever motion has led.
inline constexpr int kMaxBlockRows = 24;

/// Where a block of a group lies as seen from its reference block.
struct BlockOffset {
    std::int16_t slots = 0;
    std::int16_t rows = 0;
    std::int16_t cols = 0;
};

using BlockGroup = std::array<BlockOffset, kGroupBlocks>;

/// The group of each reference block, order (slot, row, col) of the grid.
struct BlockGroups {
    BlockGrid grid;
    std::vector<BlockGroup> groups;

    [[nodiscard]] const BlockGroup& group(int slot, int row, int col) const {
        const auto i = (static_cast<std::size_t>(slot) * static_cast<std::size_t>(grid.rows()) +
                        static_cast<std::size_t>(row)) *
                           static_cast<std::size_t>(grid.cols()) +
                       static_cast<std::size_t>(col);
        return groups[i];
    }
};

/// For each reference block of the grid the kGroupBlocks blocks with the smallest sum of squared
/// differences to it, beginning with itself, the most similar first; where there are fewer, they
/// are repeated. They are compared in the first plane; `motion` leads to other slots and is empty
/// or as `estimate_motion` returns it. The same bits for any thread count and SIMD target.
[[nodiscard]] BlockGroups match_blocks(const FluxVideo& video, const BlockGrid& grid,
                                       std::span<const MotionField> motion,
                                       const MatchingOptions& options);

}  // namespace stipple
