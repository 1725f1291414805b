#include "decoder/conventional/block_filter.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

constexpr int kBatch = 32;  ///< references that are filtered before their sums are formed

std::vector<BlockPlace> references(const BlockGrid& grid) {
    std::vector<BlockPlace> places;
    const auto count = [&](int side) {
        return (side - grid.side + grid.step_px - 1) / grid.step_px + 1;
    };
    const auto at = [&](int i, int side) { return std::min(i * grid.step_px, side - grid.side); };
    for (int frame = 0; frame < grid.frames; ++frame)
        for (int row = 0; row < count(grid.shape.rows); ++row)
            for (int col = 0; col < count(grid.shape.cols); ++col)
                places.push_back({frame, at(row, grid.shape.rows), at(col, grid.shape.cols)});
    return places;
}

/// 1 in the middle of a side, less towards its ends.
std::vector<float> window(int side) {
    std::vector<float> values;
    values.reserve(index(side));
    for (int i = 0; i < side; ++i)
        values.push_back(
            std::min(0.4F + 0.3F * static_cast<float>(std::min(i, side - 1 - i)), 1.0F));
    return values;
}

class Sums {
  public:
    explicit Sums(const BlockGrid& grid)
        : side_(grid.side),
          window_(window(grid.side)),
          sum_(grid.frames, grid.shape),
          weight_(grid.frames, grid.shape) {}

    void add(const FilteredBlocks& blocks) {
        const float* value = blocks.values.data();
        for (int plane = 0; plane < sum_.shape().planes; ++plane)
            for (const BlockPlace& place : blocks.places) {
                add_block(plane, place, {value, blocks.weights[index(plane)]});
                value += side_ * side_;
            }
    }

    FluxVideo mean() {
        parallel_for(0, sum_.slots(), [&](int frame) {
            const auto weight = std::as_const(weight_).frame(frame);
            const auto value = sum_.frame(frame);
            for (std::size_t i = 0; i < value.size(); ++i) value[i] /= weight[i];
        });
        return std::move(sum_);
    }

  private:
    struct Block {
        const float* values;
        float weight;
    };

    void add_block(int plane, const BlockPlace& place, const Block& block) {
        for (int row = 0; row < side_; ++row) {
            float* sum = &sum_.plane(place.frame, plane)(place.row + row, place.col);
            float* weight = &weight_.plane(place.frame, plane)(place.row + row, place.col);
            const float* value = block.values + row * side_;
            for (int col = 0; col < side_; ++col) {
                const float w = block.weight * window_[index(row)] * window_[index(col)];
                sum[col] += w * value[col];
                weight[col] += w;
            }
        }
    }

    int side_;
    std::vector<float> window_;
    FluxVideo sum_;
    FluxVideo weight_;
};

}  // namespace

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

std::optional<FluxVideo> filter_blocks(
    const BlockGrid& grid, const std::function<FilteredBlocks(const BlockPlace&)>& filter,
    const ProgressCallback& progress) {
    Sums sums(grid);
    const std::vector<BlockPlace> places = references(grid);
    std::vector<FilteredBlocks> batch(kBatch);
    for (std::size_t begin = 0; begin < places.size(); begin += kBatch) {
        const auto count = static_cast<int>(std::min<std::size_t>(kBatch, places.size() - begin));
        parallel_for(0, count, [&](int i) { batch[index(i)] = filter(places[begin + index(i)]); });
        for (int i = 0; i < count; ++i) sums.add(batch[index(i)]);
        const auto done = static_cast<double>(begin + index(count));
        if (!progress(done / static_cast<double>(places.size()))) return {};
    }
    return sums.mean();
}

}  // namespace stipple
