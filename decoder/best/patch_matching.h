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

/// Side in pixels of the square patches that are compared and filtered, and number of patches in a
/// group.
inline constexpr int kPatchSide = 6;
inline constexpr int kGroupPatches = 16;

/// Top left corners of the reference patches of a frame: `offset` pixels before every `step`th
/// pixel, moved into the frame if they reach beyond it. So every pixel is in a patch. Precondition:
/// rows, cols >= kPatchSide; 1 <= step <= kPatchSide; 0 <= offset < step.
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

/// Search range of similar patches.
struct MatchingOptions {
    int slots = 10;       ///< before and after the slot of the reference
    int own_radius = 2;   ///< pixels around the reference, in its own slot
    int path_radius = 1;  ///< pixels around its position along motion, in other slots
};

/// Maximum distance in rows of a patch from its reference, for any motion.
inline constexpr int kMaxPatchRows = 24;

/// Position of a patch relative to its reference patch.
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
/// differences to it, the most similar first, beginning with itself; they are repeated if there are
/// fewer. Only the first plane is compared. `motion` leads to other slots; it is empty or the
/// result of `estimate_motion`. The same bits for any thread count and SIMD target.
[[nodiscard]] PatchGroups match_patches(const FluxVideo& video, const ReferenceGrid& grid,
                                        std::span<const MotionField> motion,
                                        const MatchingOptions& options);

}  // namespace stipple
