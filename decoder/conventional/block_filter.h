#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/motion/motion.h"

namespace stipple {

/// The top left pixel of a block in a frame.
struct BlockPlace {
    int frame = 0;
    int row = 0;
    int col = 0;
};

/// Follows blocks of `side` x `side` pixels along the motion of their middle, rounded to whole
/// pixels. Precondition: rows, cols >= side.
class BlockPaths {
  public:
    /// Estimates the motion of `video`; frames smaller than kMinMotionSide have none.
    BlockPaths(const FluxVideo& video, int side);

    /// Replaces `path` by the places of a block in up to `reach` frames before and after its own,
    /// in the order of the frames. A path ends where the motion has less than `min_confidence`.
    void follow(const BlockPlace& start, int reach, std::uint8_t min_confidence,
                std::vector<BlockPlace>& path) const;

    /// As `follow`, in exactly the frames from `first` to `last`, whatever the confidence.
    /// Precondition: first <= start.frame <= last.
    void follow_unchecked(const BlockPlace& start, int first, int last,
                          std::vector<BlockPlace>& path) const;

  private:
    /// Appends the places in the frames after (step 1) or before (step -1) the start.
    void walk(const BlockPlace& start, int step, int frames, int min_confidence,
              std::vector<BlockPlace>& path) const;

    int frames_;
    FrameShape shape_;
    int side_;
    std::vector<MotionField> motion_;
};

/// Filtered blocks of one reference block: values in the order (plane, place, row, col).
struct FilteredBlocks {
    std::vector<BlockPlace> places;
    std::vector<float> values;
    std::vector<float> weights;  ///< of each plane, > 0
};

/// Reference blocks of `side` x `side` pixels, every `step_px` pixels of each frame; the last ones
/// of a row and column end with the frame. Precondition: rows, cols >= side >= step_px >= 1.
struct BlockGrid {
    int frames = 0;
    FrameShape shape;
    int side = 8;
    int step_px = 4;
};

/// The weighted mean of all blocks that `filter` gives, times a window that decreases towards the
/// border of a block. `filter` is called once for each reference block, in several threads, and its
/// result contains the reference. The same bits for any thread count: sums are in the order of the
/// references. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> filter_blocks(
    const BlockGrid& grid, const std::function<FilteredBlocks(const BlockPlace&)>& filter,
    const ProgressCallback& progress);

}  // namespace stipple
