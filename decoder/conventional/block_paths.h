#pragma once

#include <cstdint>
#include <vector>

#include "core/flux_video.h"
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

}  // namespace stipple
