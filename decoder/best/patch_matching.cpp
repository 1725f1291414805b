#include "decoder/best/patch_matching.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/best/patch_kernels.h"

namespace stipple {
namespace {

struct PatchPlace {
    int slot = 0;
    int row = 0;
    int col = 0;
};

struct ImageSize {
    int slots = 0;
    FrameShape shape;
};

/// Order (slot, row, col), and two values more, which a patch in the last corner reads beyond it.
std::vector<float> first_planes(const FluxVideo& video) {
    const std::size_t pixels = video.shape().pixels();
    std::vector<float> image;
    image.reserve(index(video.slots()) * pixels + 2);
    for (int slot = 0; slot < video.slots(); ++slot) {
        const auto plane = video.frame(slot).first(pixels);
        image.insert(image.end(), plane.begin(), plane.end());
    }
    image.resize(image.size() + 2);
    return image;
}

/// Finds groups, one after the other.
class Matcher {
  public:
    Matcher(std::span<const float> image, const ImageSize& size,
            std::span<const MotionField> motion, const MatchingOptions& options)
        : image_(image),
          shape_(size.shape),
          slots_(size.slots),
          motion_(motion),
          options_(options) {}

    [[nodiscard]] PatchGroup group(const PatchPlace& reference) {
        reference_ = reference;
        offsets_.assign(1, {});  // first among equals, so that every group has its reference
        voxels_.assign(1, static_cast<std::uint32_t>(voxel(reference)));
        add_around(reference, options_.own_radius);
        for (const int step : {1, -1}) follow(step);
        differences_.resize(voxels_.size());
        squared_differences(image_.data(), &image_[voxel(reference)], voxels_, shape_.cols,
                            differences_.data());
        return most_similar();
    }

  private:
    [[nodiscard]] std::size_t voxel(const PatchPlace& at) const {
        return index(at.slot) * shape_.pixels() + row_major(at.row, at.col, shape_.cols);
    }

    void add_around(const PatchPlace& centre, int radius) {
        const auto last = [&](int at, int side) {
            return std::min(at + radius, side - kPatchSide);
        };
        const int first_row = std::max({centre.row - radius, reference_.row - kMaxPatchRows, 0});
        const int last_row =
            std::min(last(centre.row, shape_.rows), reference_.row + kMaxPatchRows);
        for (int row = first_row; row <= last_row; ++row)
            for (int col = std::max(centre.col - radius, 0); col <= last(centre.col, shape_.cols);
                 ++col) {
                if (centre.slot == reference_.slot && row == reference_.row &&
                    col == reference_.col)
                    continue;
                voxels_.push_back(static_cast<std::uint32_t>(voxel({centre.slot, row, col})));
                offsets_.push_back(
                    {.slots = static_cast<std::int16_t>(centre.slot - reference_.slot),
                     .rows = static_cast<std::int16_t>(row - reference_.row),
                     .cols = static_cast<std::int16_t>(col - reference_.col)});
            }
    }

    /// Adds the patches around the path that motion takes the middle of the reference along.
    void follow(int step) {
        constexpr int kUnit = MotionField::kShiftsPerPixel;
        const auto pixel = [](int position, int side) {
            return std::clamp((position + kUnit / 2) / kUnit, 0, side - 1);
        };
        int row = (reference_.row + kPatchSide / 2) * kUnit;
        int col = (reference_.col + kPatchSide / 2) * kUnit;
        PatchPlace middle = reference_;
        for (int i = 0; i < options_.slots; ++i) {
            middle.row = pixel(row, shape_.rows);
            middle.col = pixel(col, shape_.cols);
            for (const MotionField& field : motion_)
                if (field.step == step) {
                    row += field.row_shift[voxel(middle)];
                    col += field.col_shift[voxel(middle)];
                }
            middle.slot += step;
            if (middle.slot < 0 || middle.slot >= slots_) return;
            add_around({middle.slot, pixel(row, shape_.rows) - kPatchSide / 2,
                        pixel(col, shape_.cols) - kPatchSide / 2},
                       options_.path_radius);
        }
    }

    [[nodiscard]] PatchGroup most_similar() {
        order_.clear();
        order_.reserve(differences_.size());
        for (std::size_t i = 0; i < differences_.size(); ++i)
            order_.emplace_back(differences_[i], static_cast<std::uint32_t>(i));
        const auto count = std::min<std::size_t>(order_.size(), kGroupPatches);
        std::partial_sort(order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(count),
                          order_.end());
        PatchGroup group;
        for (std::size_t i = 0; i < group.size(); ++i)
            group[i] = offsets_[order_[i % count].second];
        return group;
    }

    std::span<const float> image_;
    FrameShape shape_;
    int slots_;
    std::span<const MotionField> motion_;
    MatchingOptions options_;
    PatchPlace reference_;
    std::vector<PatchOffset> offsets_;
    std::vector<std::uint32_t> voxels_;
    std::vector<float> differences_;
    std::vector<std::pair<float, std::uint32_t>> order_;
};

}  // namespace

PatchGroups match_patches(const FluxVideo& video, const ReferenceGrid& grid,
                          std::span<const MotionField> motion, const MatchingOptions& options) {
    const FrameShape shape = grid.shape;
    assert(shape.rows >= kPatchSide && shape.cols >= kPatchSide);
    const std::vector<float> image = first_planes(video);
    assert(image.size() <= UINT32_MAX);
    PatchGroups result{.grid = grid,
                       .groups = std::vector<PatchGroup>(index(video.slots()) * index(grid.rows()) *
                                                         index(grid.cols()))};
    parallel_for(0, video.slots() * grid.rows(), [&](int i) {
        Matcher matcher(image, {video.slots(), shape}, motion, options);
        const PatchPlace row{.slot = i / grid.rows(), .row = grid.row(i % grid.rows()), .col = 0};
        for (int col = 0; col < grid.cols(); ++col)
            result.groups[index(i) * index(grid.cols()) + index(col)] =
                matcher.group({row.slot, row.row, grid.col(col)});
    });
    return result;
}

}  // namespace stipple
