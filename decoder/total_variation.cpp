#include "decoder/total_variation.h"

#include <algorithm>
#include <cassert>
#include <cstddef>

#include "core/parallel.h"
#include "decoder/data_prox.h"
#include "decoder/gradient_kernels.h"
#include "decoder/motion_kernels.h"
#include "decoder/opponent_planes.h"

namespace stipple {
namespace {

/// Bounds of the squared norm of the spatial gradient and of one temporal difference.
constexpr float kSpatialCoupling = 8;
constexpr float kTemporalCoupling = 4;

std::size_t index(int value) {
    return static_cast<std::size_t>(value);
}

/// Planes whose differences share a norm.
struct PlaneGroup {
    int first_plane;
    int planes;
    float weight;  ///< of that of all
};

std::vector<PlaneGroup> plane_groups(FrameShape shape, float chroma_weight) {
    if (shape.planes != 3 || chroma_weight == 0) return {{0, shape.planes, 1}};
    return {{0, 1, 1}, {1, 2, chroma_weight}};
}

/// The iteration and all that it remembers. Arrays have the order of FluxVideo; where there are
/// opponents, all but x and the point of the proximal map are of these instead of R, G, B.
class PrimalDual {
  public:
    PrimalDual(const Measurements& measurements, std::span<const MotionField> motion,
               std::span<const float> step, const TotalVariationOptions& options, FluxVideo& x)
        : measurements_(measurements),
          motion_(motion),
          step_(step),
          options_(options),
          shape_(x.shape()),
          groups_(plane_groups(shape_, options.chroma_weight)),
          x_(x.data()),
          extrapolated_(x_.begin(), x_.end()),
          gradient_(x_.size()),
          dual_col_(x_.size()),
          dual_row_(x_.size()),
          dual_link_(std::max<std::size_t>(motion.size(), 1), std::vector<float>(x_.size())) {
        if (groups_.size() > 1)
            for (int slot = 0; slot < measurements.slots; ++slot)
                to_opponents(shape_.pixels(), triple(extrapolated_, slot, 0));
    }

    void iterate() {
        parallel_for(0, measurements_.slots, [&](int slot) { update_duals(slot); });
        parallel_for(0, measurements_.slots, [&](int slot) { add_partner_gradients(slot); });
        const int runs = static_cast<int>((shape_.pixels() + kMaxRunSites - 1) / kMaxRunSites);
        parallel_for(0, runs, [&](int i) {
            const std::size_t begin = index(i) * kMaxRunSites;
            update_primal({begin, std::min(begin + kMaxRunSites, shape_.pixels())});
        });
    }

  private:
    [[nodiscard]] PlaneTriple triple(std::vector<float>& x, int slot, std::size_t pixel) const {
        float* first = &x[frame(slot) + pixel];
        return {first, first + shape_.pixels(), first + 2 * shape_.pixels()};
    }
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
        for (const PlaneGroup& group : groups_) update_duals(slot, group);
    }

    void update_duals(int slot, const PlaneGroup& group) {
        FrameShape shape = shape_;
        shape.planes = group.planes;
        const std::size_t skipped = index(group.first_plane) * shape_.pixels();
        const std::size_t first = frame(slot) + skipped;
        float* gradient = &gradient_[first];
        const float* now = &extrapolated_[first];
        update_spatial_dual(shape, dual_step(slot, group.weight * options_.spatial_weight), now,
                            {&dual_col_[first], &dual_row_[first]}, gradient);
        const auto temporal = dual_step(
            slot, group.weight * options_.temporal_weight / static_cast<float>(dual_link_.size()));
        if (motion_.empty() && has(slot + 1))
            update_static_dual(shape, temporal, {now, now + shape_.sites()}, &dual_link_[0][first],
                               gradient);
        for (std::size_t i = 0; i < motion_.size(); ++i) {
            const int partner = slot + motion_[i].step;
            if (!has(partner)) continue;
            MotionLink along = link(i, slot);
            along.shape = shape;
            along.dual += skipped;
            update_motion_dual(along, temporal, {now, &extrapolated_[frame(partner) + skipped]},
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
    void update_primal(const SiteRun& pixels) {
        const bool opponents = groups_.size() > 1;
        const std::size_t count = pixels.end - pixels.begin;
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            if (opponents) from_opponents(count, triple(gradient_, slot, pixels.begin));
            for (int plane = 0; plane < shape_.planes; ++plane) {
                const std::size_t i = frame(slot) + index(plane) * shape_.pixels() + pixels.begin;
                descend(count, &step_[index(slot) * shape_.pixels() + pixels.begin], &x_[i],
                        &gradient_[i]);
            }
        }
        for (std::size_t plane = 0; plane < shape_.sites(); plane += shape_.pixels())
            data_prox(measurements_, {plane + pixels.begin, plane + pixels.end}, step_, gradient_);
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            for (int plane = 0; plane < shape_.planes; ++plane) {
                const std::size_t i = frame(slot) + index(plane) * shape_.pixels() + pixels.begin;
                extrapolate(count, &gradient_[i], &x_[i], &extrapolated_[i]);
            }
            if (opponents) to_opponents(count, triple(extrapolated_, slot, pixels.begin));
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
    std::vector<PlaneGroup> groups_;
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
