#include "decoder/best/patch_kernels.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <utility>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// Cuts [0, count) into equal bands, as many as can be at least `min_length` long, and at least
/// one.
class Bands {
  public:
    Bands(int count, int min_length) : count_(count), bands_(std::max(1, count / min_length)) {}
    [[nodiscard]] int size() const { return bands_; }
    [[nodiscard]] int begin(int band) const { return count_ * band / bands_; }

  private:
    int count_;
    int bands_;
};

int farthest_slots(const PatchGroups& groups) {
    int farthest = 0;
    for (const PatchGroup& group : groups.groups)
        for (const PatchOffset& patch : group)
            farthest = std::max(farthest, std::abs(static_cast<int>(patch.slots)));
    return farthest;
}

/// Adds up what the groups say. Groups reach into the bands beside their own but no further, so of
/// the bands of rows and of slots every other one can be worked on at the same time, in any order.
class Aggregation {
  public:
    Aggregation(const FluxVideo& noisy, const FluxVideo& pilot, const PatchGroups& groups,
                float sigma, const FilteredVideo& result)
        : noisy_(noisy),
          pilot_(pilot),
          groups_(groups),
          sigma_(sigma),
          sum_(result.filtered),
          weight_(noisy.slots(), noisy.shape()),
          window_(result.noise_gain) {}

    void run() {
        const ReferenceGrid& grid = groups_.grid;
        const Bands rows(grid.rows(), (2 * kMaxPatchRows + kPatchSide) / grid.step + 2);
        const Bands slots(noisy_.slots(), std::max(1, 2 * farthest_slots(groups_)));
        for (const int first_slots : {0, 1})
            for (const int first_rows : {0, 1}) {
                const int of_rows = (rows.size() - first_rows + 1) / 2;
                const int of_slots = (slots.size() - first_slots + 1) / 2;
                parallel_for(0, of_rows * of_slots, [&](int i) {
                    const int row_band = first_rows + 2 * (i % of_rows);
                    const int slot_band = first_slots + 2 * (i / of_rows);
                    for (int slot = slots.begin(slot_band); slot < slots.begin(slot_band + 1);
                         ++slot)
                        for (int row = rows.begin(row_band); row < rows.begin(row_band + 1); ++row)
                            filter_row(slot, row);
                });
            }
    }

    /// Sums become means.
    void divide() {
        parallel_for(0, sum_.slots(), [&](int slot) {
            const auto weight = std::as_const(weight_).frame(slot);
            const auto value = sum_.frame(slot);
            for (std::size_t i = 0; i < value.size(); ++i) value[i] /= weight[i];
            if (window_ == nullptr) return;
            const auto window = window_->frame(slot);
            const float planes = sum_.shape().planes == 3 ? 3 : 1;  // filtered together
            for (std::size_t i = 0; i < window.size(); ++i) window[i] /= planes * weight[i];
        });
    }

  private:
    void filter_row(int slot, int row) {
        const ReferenceGrid& grid = groups_.grid;
        const FrameShape shape = noisy_.shape();
        for (int col = 0; col < grid.cols(); ++col) {
            std::size_t voxel = index(slot) * shape.sites() +
                                index(grid.row(row)) * index(shape.cols) + index(grid.col(col));
            const PatchGroup& group = groups_.group(slot, row, col);
            if (shape.planes == 3) {
                filter_group({frames_at(voxel, group), frames_at(voxel + shape.pixels(), group),
                              frames_at(voxel + 2 * shape.pixels(), group)},
                             sigma_);
                continue;
            }
            for (int plane = 0; plane < shape.planes; ++plane, voxel += shape.pixels())
                filter_group(frames_at(voxel, group), sigma_);
        }
    }

    /// `voxel` is the first of the reference patch in a plane.
    GroupFrames frames_at(std::size_t voxel, const PatchGroup& group) {
        const FrameShape shape = noisy_.shape();
        GroupFrames frames{.noisy = &noisy_.data()[voxel],
                           .pilot = &pilot_.data()[voxel],
                           .sum = &sum_.data()[voxel],
                           .weight = &weight_.data()[voxel],
                           .window = window_ == nullptr ? nullptr : &window_->data()[voxel],
                           .cols = shape.cols};
        for (std::size_t k = 0; k < group.size(); ++k)
            frames.patch[k] = static_cast<std::ptrdiff_t>(shape.sites()) * group[k].slots +
                              frames.cols * group[k].rows + group[k].cols;
        return frames;
    }

    const FluxVideo& noisy_;
    const FluxVideo& pilot_;
    const PatchGroups& groups_;
    float sigma_;
    FluxVideo& sum_;
    FluxVideo weight_;
    FluxVideo* window_;
};

}  // namespace

void filter_groups(const FluxVideo& noisy, const FluxVideo& pilot, const PatchGroups& groups,
                   float sigma, const FilteredVideo& result) {
    assert(pilot.voxels() == noisy.voxels() && result.filtered.voxels() == noisy.voxels());
    std::ranges::fill(result.filtered.data(), 0.0F);
    if (result.noise_gain != nullptr) *result.noise_gain = FluxVideo(noisy.slots(), noisy.shape());
    Aggregation aggregation(noisy, pilot, groups, sigma, result);
    aggregation.run();
    aggregation.divide();
}

ColourMatrix principal_colour_axes(const ColourMatrix& covariance) noexcept {
    using Rows = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;
    const Eigen::SelfAdjointEigenSolver<Rows> solver(Eigen::Map<const Rows>(covariance[0].data()));
    ColourMatrix axes;
    Eigen::Map<Rows>(axes[0].data()) = solver.eigenvectors();
    return axes;
}

}  // namespace stipple
