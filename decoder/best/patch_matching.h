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

/// Side of the square patches that are compared and filtered, in pixels, and patches of a group.
inline constexpr int kPatchSide = 6;
inline constexpr int kGroupPatches = 16;

/// Top left corners of the reference patches of a frame: `offset` pixels back from every `step`th
/// pixel, moved into the frame where they reach beyond it. So every pixel is in a patch.
/// Precondition: rows, cols >= kPatchSide; 1 <= step <= kPatchSide; 0 <= offset < step.
struct ReferenceGrid {
    FrameShape shape;
    int step = 5;
    int offset = 0;

    [[nodiscard]] int rows() const { return count(shape.rows); }
    [[nodiscard]] int cols() const { return count(shape.cols); }
    [[nodiscard]] int row(int i) const { return place(i, shape.rows); }
    [[nodiscard]] int col(int i) const { return place(i, shape.cols); }

  private:
    [[nodiscard]] int count(int side) const {
        return (side - kPatchSide + offset + step - 1) / step + 1;
    }
    [[nodiscard]] int place(int i, int side) const {
        const int at = i * step - offset;
        return at < 0 ? 0 : at < side - kPatchSide ? at : side - kPatchSide;
    }
};

/// Where similar patches are looked for.
struct MatchingOptions {
    int slots = 10;       ///< before and after the slot of the reference
    int own_radius = 2;   ///< pixels around the reference, in its own slot
    int path_radius = 1;  ///< pixels around where motion has taken it, in the other slots
};

/// A patch of a group is at most so many rows from its reference, wherever motion has led.
inline constexpr int kMaxPatchRows = 24;

/// Where a patch of a group lies as seen from its reference patch.
struct PatchOffset {
    std::int16_t slots = 0;
    std::int16_t rows = 0;
    std::int16_t cols = 0;
};

using PatchGroup = std::array<PatchOffset, kGroupPatches>;

/// The group of each reference patch, order (slot, row, col) of the grid.
struct PatchGroups {
    ReferenceGrid grid;
    std::vector<PatchGroup> groups;

    [[nodiscard]] const PatchGroup& group(int slot, int row, int col) const {
        const auto i = (static_cast<std::size_t>(slot) * static_cast<std::size_t>(grid.rows()) +
                        static_cast<std::size_t>(row)) *
                           static_cast<std::size_t>(grid.cols()) +
                       static_cast<std::size_t>(col);
        return groups[i];
    }
};

/// For each reference patch of the grid the kGroupPatches patches with the smallest sum of squared
/// differences to it, beginning with itself, the most similar first; where there are fewer, they
/// are repeated. They are compared in the first plane; `motion` leads to other slots and is empty
/// or as `estimate_motion` returns it. The same bits for any thread count and SIMD target.
[[nodiscard]] PatchGroups match_patches(const FluxVideo& video, const ReferenceGrid& grid,
                                        std::span<const MotionField> motion,
                                        const MatchingOptions& options);

}  // namespace stipple
