#include "decoder/total_variation.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/parallel.h"
#include "decoder/data_prox.h"
#include "decoder/gradient_kernels.h"
#include "decoder/motion_kernels.h"

namespace stipple {
namespace {

/// Bounds of the squared norm of the spatial gradient and of one temporal difference.
constexpr float kSpatialCoupling = 8;
constexpr float kTemporalCoupling = 4;

std::size_t index(int value) {
    return static_cast<std::size_t>(value);
}

/// The iteration and all that it remembers. Arrays have the order of FluxVideo.
class PrimalDual {
  public:
    PrimalDual(const Measurements& measurements, std::span<const MotionField> motion,
               std::span<const float> step, const TotalVariationOptions& options, FluxVideo& x)
        : measurements_(measurements),
          motion_(motion),
          step_(step),
          options_(options),
          shape_(x.shape()),
          x_(x.data()),
          extrapolated_(x_.begin(), x_.end()),
          gradient_(x_.size()),
          dual_col_(x_.size()),
          dual_row_(x_.size()),
          dual_link_(std::max<std::size_t>(motion.size(), 1), std::vector<float>(x_.size())) {}

    void iterate() {
        parallel_for(0, measurements_.slots, [&](int slot) { update_duals(slot); });
        parallel_for(0, measurements_.slots, [&](int slot) { add_partner_gradients(slot); });
        const int runs = static_cast<int>((shape_.pixels() + kMaxRunSites - 1) / kMaxRunSites);
        parallel_for(0, shape_.planes * runs, [&](int i) {
            const std::size_t plane = index(i / runs) * shape_.pixels();
            const std::size_t begin = index(i % runs) * kMaxRunSites;
            update_primal({plane + begin, plane + std::min(begin + kMaxRunSites, shape_.pixels())});
        });
    }

  private:
    [[nodiscard]] bool has(int slot) const { return slot >= 0 && slot < measurements_.slots; }
    [[nodiscard]] std::size_t frame(int slot) const { return index(slot) * shape_.sites(); }

    [[nodiscard]] DualStep dual_step(int slot, float weight) const {
        const auto links = static_cast<float>(dual_link_.size());
        return {.step = &step_[index(slot) * shape_.pixels()],
                .coupling = kSpatialCoupling + kTemporalCoupling * links,
                .weight = weight,
                .reference_step = options_.reference_step};
    }

    [[nodiscard]] MotionLink link(std::size_t i, int slot) {
        const std::size_t pixel = index(slot) * shape_.pixels();
        return {.shape = shape_,
                .row_shift = &motion_[i].row_shift[pixel],
                .col_shift = &motion_[i].col_shift[pixel],
                .confidence = &motion_[i].confidence[pixel],
                .dual = &dual_link_[i][frame(slot)]};
    }

    /// All duals of differences that begin in `slot`, and what of their gradient stays in it.
    void update_duals(int slot) {
        float* gradient = &gradient_[frame(slot)];
        const float* now = &extrapolated_[frame(slot)];
        update_spatial_dual(shape_, dual_step(slot, options_.spatial_weight), now,
                            {&dual_col_[frame(slot)], &dual_row_[frame(slot)]}, gradient);
        const auto temporal =
            dual_step(slot, options_.temporal_weight / static_cast<float>(dual_link_.size()));
        if (motion_.empty() && has(slot + 1))
            update_static_dual(shape_, temporal, {now, &extrapolated_[frame(slot + 1)]},
                               &dual_link_[0][frame(slot)], gradient);
        for (std::size_t i = 0; i < motion_.size(); ++i) {
            const int partner = slot + motion_[i].step;
            if (has(partner))
                update_motion_dual(link(i, slot), temporal, {now, &extrapolated_[frame(partner)]},
                                   gradient);
        }
    }

    /// What the duals of other slots say of this one.
    void add_partner_gradients(int slot) {
        float* gradient = &gradient_[frame(slot)];
        if (motion_.empty() && has(slot - 1)) {
            const float* dual = &dual_link_[0][frame(slot - 1)];
            for (std::size_t i = 0; i < shape_.sites(); ++i) gradient[i] += dual[i];
        }
        for (std::size_t i = 0; i < motion_.size(); ++i)
            if (has(slot - motion_[i].step))
                add_partner_gradient(link(i, slot - motion_[i].step), gradient);
    }

    /// x' = prox(x - step gradient); extrapolated = 2 x' - x
    void update_primal(const SiteRun& run) {
        const std::size_t count = run.end - run.begin;
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            const std::size_t i = frame(slot) + run.begin;
            descend(count, &step_[index(slot) * shape_.pixels() + run.begin % shape_.pixels()],
                    &x_[i], &gradient_[i]);
        }
        data_prox(measurements_, run, step_, gradient_);
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            const std::size_t i = frame(slot) + run.begin;
            extrapolate(count, &gradient_[i], &x_[i], &extrapolated_[i]);
        }
    }

    /// gradient = x - step gradient
    static void descend(std::size_t count, const float* step, const float* x, float* gradient) {
        for (std::size_t i = 0; i < count; ++i) gradient[i] = x[i] - step[i] * gradient[i];
    }
    static void extrapolate(std::size_t count, const float* next, float* x, float* extrapolated) {
        for (std::size_t i = 0; i < count; ++i) {
            extrapolated[i] = 2 * next[i] - x[i];
            x[i] = next[i];
        }
    }

    const Measurements& measurements_;
    std::span<const MotionField> motion_;
    std::span<const float> step_;
    TotalVariationOptions options_;
    FrameShape shape_;
    std::span<float> x_;
    std::vector<float> extrapolated_;
    std::vector<float> gradient_;  ///< then the point that the proximal map takes
    std::vector<float> dual_col_;
    std::vector<float> dual_row_;
    std::vector<std::vector<float>> dual_link_;
};

}  // namespace

void minimise_total_variation(const Measurements& measurements, std::span<const MotionField> motion,
                              std::span<const float> step, const TotalVariationOptions& options,
                              FluxVideo& x) {
    assert(measurements.voxels() == x.voxels() && x.slots() == measurements.slots);
    PrimalDual solver(measurements, motion, step, options, x);
    for (int i = 0; i < options.iterations; ++i) {
        solver.iterate();
        if (!options.after_iteration()) return;
    }
}

}  // namespace stipple
