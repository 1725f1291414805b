#include "decoder/fast/total_variation.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "decoder/fast/gradient_kernels.h"
#include "decoder/joint/joint_prox.h"
#include "decoder/measurements.h"
#include "decoder/pixel_transforms.h"

namespace stipple {
namespace {

/// Bounds of the squared norm of the spatial gradient and of one temporal difference.
constexpr float kSpatialCoupling = 8;
constexpr float kTemporalCoupling = 4;

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

}  // namespace

/// The iteration and all that it remembers. Arrays have the order of FluxVideo; where there are
/// opponents, all but x and the point of the proximal map are of these instead of R, G, B.
class TotalVariationSolver::Impl {
  public:
    explicit Impl(const Measurements& measurements)
        : measurements_(measurements),
          shape_(measurements.shape),
          runs_(site_runs({.rows = shape_.rows, .cols = shape_.cols, .planes = 1})),
          extrapolated_(new_array()),
          gradient_(new_array()),
          dual_col_(new_array()),
          dual_row_(new_array()),
          prox_(measurements) {}

    /// What `minimise` of the solver does, up to the first iteration.
    void begin(std::span<const MotionField> motion, std::span<const float> step,
               const TotalVariationOptions& options, FluxVideo& x) {
        motion_ = motion;
        step_ = step;
        options_ = &options;
        groups_ = plane_groups(shape_, options.chroma_weight);
        x_ = x.data();
        links_ = std::max<std::size_t>(motion.size(), 1);
        while (dual_link_.size() < links_) dual_link_.push_back(new_array());
        parallel_for(0, measurements_.slots, [&](int slot) {
            const std::size_t first = frame(slot);
            std::copy_n(&x_[first], shape_.sites(), &extrapolated_[first]);
            if (groups_.size() > 1) to_opponents(shape_.pixels(), triple(extrapolated_, slot, 0));
            std::fill_n(&dual_col_[first], shape_.sites(), 0.0F);
            std::fill_n(&dual_row_[first], shape_.sites(), 0.0F);
            for (std::size_t i = 0; i < links_; ++i)
                std::fill_n(&dual_link_[i][first], shape_.sites(), 0.0F);
        });
    }

    /// An iteration of Chambolle and Pock (J. Math. Imaging Vis. 40(1), 2011, algorithm 1), with a
    /// step for each pixel. K: all differences; F: data term.
    void iterate() {
        // p <- project(p + sigma K x_bar), and what of K^T p lies in the slot of the difference
        parallel_for(0, measurements_.slots, [&](int slot) { update_duals(slot); });

        // the rest of K^T p: differences that end in a slot
        parallel_for(0, measurements_.slots, [&](int slot) { add_partner_gradients(slot); });

        // x' <- prox_(tau F)(x - tau K^T p);  x_bar <- 2 x' - x
        parallel_for(0, static_cast<int>(runs_.size()),
                     [&](int i) { update_primal(runs_[index(i)]); });
    }

  private:
    /// Left as it comes: setting it to 0 here would keep the other threads waiting.
    using Array = std::unique_ptr<float[]>;

    [[nodiscard]] Array new_array() const {
        return std::make_unique_for_overwrite<float[]>(measurements_.voxels());
    }
    [[nodiscard]] PlaneTriple triple(const Array& x, int slot, std::size_t pixel) const {
        float* first = &x[frame(slot) + pixel];
        return {first, first + shape_.pixels(), first + 2 * shape_.pixels()};
    }
    [[nodiscard]] bool has(int slot) const { return slot >= 0 && slot < measurements_.slots; }
    [[nodiscard]] std::size_t frame(int slot) const { return index(slot) * shape_.sites(); }

    [[nodiscard]] DualStep dual_step(int slot, float weight) const {
        const auto links = static_cast<float>(links_);
        return {.step = &step_[index(slot) * shape_.pixels()],
                .coupling = kSpatialCoupling + kTemporalCoupling * links,
                .weight = weight,
                .reference_step = options_->reference_step};
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

        // in the frame: to the right and below
        update_spatial_dual(shape, dual_step(slot, group.weight * options_->spatial_weight), now,
                            {&dual_col_[first], &dual_row_[first]}, gradient);

        // in time: to the same pixel of the next slot, or along each motion field
        const auto temporal =
            dual_step(slot, group.weight * options_->temporal_weight / static_cast<float>(links_));
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

    void update_primal(const SiteRun& pixels) {
        const bool opponents = groups_.size() > 1;
        const std::size_t count = pixels.end - pixels.begin;

        // x - tau K^T p
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            if (opponents) from_opponents(count, triple(gradient_, slot, pixels.begin));
            for (int plane = 0; plane < shape_.planes; ++plane) {
                const std::size_t i = frame(slot) + index(plane) * shape_.pixels() + pixels.begin;
                descend(count, &step_[index(slot) * shape_.pixels() + pixels.begin], &x_[i],
                        &gradient_[i]);
            }
        }

        // prox of the data term, a pixel over all slots at a time
        for (std::size_t plane = 0; plane < shape_.sites(); plane += shape_.pixels())
            prox_({plane + pixels.begin, plane + pixels.end}, step_,
                  {gradient_.get(), measurements_.voxels()});

        // x_bar = 2 x' - x
        for (int slot = 0; slot < measurements_.slots; ++slot) {
            for (int plane = 0; plane < shape_.planes; ++plane) {
                const std::size_t i = frame(slot) + index(plane) * shape_.pixels() + pixels.begin;
                extrapolate(count, &gradient_[i], &x_[i], &extrapolated_[i]);
            }
            if (opponents) to_opponents(count, triple(extrapolated_, slot, pixels.begin));
        }
    }

    const Measurements& measurements_;
    FrameShape shape_;
    std::vector<SiteRun> runs_;  ///< of the pixels of a plane
    std::span<const MotionField> motion_;
    std::span<const float> step_;
    const TotalVariationOptions* options_ = nullptr;
    std::vector<PlaneGroup> groups_;
    std::span<float> x_;
    std::size_t links_ = 0;  ///< from a voxel
    Array extrapolated_;
    Array gradient_;  ///< then the point that the proximal map takes
    Array dual_col_;
    Array dual_row_;
    std::vector<Array> dual_link_;
    JointProx prox_;
};

TotalVariationSolver::TotalVariationSolver(const Measurements& measurements)
    : impl_(std::make_unique<Impl>(measurements)) {}

TotalVariationSolver::~TotalVariationSolver() = default;

void TotalVariationSolver::minimise(std::span<const MotionField> motion,
                                    std::span<const float> step,
                                    const TotalVariationOptions& options, FluxVideo& x) {
    impl_->begin(motion, step, options, x);
    for (int i = 0; i < options.iterations; ++i) {
        impl_->iterate();
        if (!options.keep_going()) return;
    }
}

}  // namespace stipple
