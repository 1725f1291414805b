#include "decoder/conventional/block_paths.h"

#include <algorithm>
#include <cassert>

#include "core/index.h"

namespace stipple {

BlockPaths::BlockPaths(const FluxVideo& video, int side)
    : frames_(video.slots()), shape_(video.shape()), side_(side) {
    assert(std::min(shape_.rows, shape_.cols) >= side);
    if (frames_ > 1 && std::min(shape_.rows, shape_.cols) >= kMinMotionSide)
        motion_ = estimate_motion(video, {});
}

void BlockPaths::follow(const BlockPlace& start, int reach, std::uint8_t min_confidence,
                        std::vector<BlockPlace>& path) const {
    path.clear();
    walk(start, -1, std::min(reach, start.frame), min_confidence, path);
    std::ranges::reverse(path);
    path.push_back(start);
    walk(start, 1, std::min(reach, frames_ - 1 - start.frame), min_confidence, path);
}

void BlockPaths::follow_unchecked(const BlockPlace& start, int first, int last,
                                  std::vector<BlockPlace>& path) const {
    path.clear();
    walk(start, -1, start.frame - first, 0, path);
    std::ranges::reverse(path);
    path.push_back(start);
    walk(start, 1, last - start.frame, 0, path);
}

void BlockPaths::walk(const BlockPlace& start, int step, int frames, int min_confidence,
                      std::vector<BlockPlace>& path) const {
    constexpr int kUnit = MotionField::kShiftsPerPixel;
    const auto pixel = [](int position, int side) {
        return std::clamp((position + kUnit / 2) / kUnit, 0, side - 1);
    };
    int row = (start.row + side_ / 2) * kUnit;
    int col = (start.col + side_ / 2) * kUnit;
    for (int i = 0; i < frames; ++i) {
        const std::size_t at =
            index(start.frame + step * i) * shape_.pixels() +
            row_major(pixel(row, shape_.rows), pixel(col, shape_.cols), shape_.cols);
        for (const MotionField& field : motion_) {
            if (field.step != step) continue;
            if (field.confidence[at] < min_confidence) return;
            row += field.row_shift[at];
            col += field.col_shift[at];
        }
        path.push_back({start.frame + step * (i + 1),
                        std::clamp(pixel(row, shape_.rows) - side_ / 2, 0, shape_.rows - side_),
                        std::clamp(pixel(col, shape_.cols) - side_ / 2, 0, shape_.cols - side_)});
    }
}

}  // namespace stipple
