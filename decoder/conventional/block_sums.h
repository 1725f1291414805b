#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/conventional/block_paths.h"

namespace stipple {

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
