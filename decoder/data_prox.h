#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/geometry.h"

namespace stipple {

struct Measurements;

/// Sites [begin, end) of one plane, in all slots.
struct SiteRun {
    std::size_t begin = 0;
    std::size_t end = 0;
};

/// Limits of a run, so that its data stay in the cache of a core.
inline constexpr std::size_t kMaxRunSites = 256;
inline constexpr int kMaxRunSlots = 128;

/// All sites of a frame, in runs of maximum length.
[[nodiscard]] std::vector<SiteRun> site_runs(FrameShape shape);

/// Proximal map of the data term, in place:
///   argmin_x  sum_t (x_t - v_t)^2 / (2 step_t) + sum_k (y_k - (A x)_k)^2 / (2 variance_k).
/// Exposures share no voxel, so it has the closed form x_t = v_t + w_t step_t (y - sum w v) /
/// (variance + sum w^2 step), w the weights. A saturated exposure only increases its voxels. `v`
/// contains all voxels. `step` has one value per slot and pixel, order (slot, row, col), for all
/// planes. The same bits for any SIMD target. Precondition: the run lies within one plane; run and
/// slots are within the limits above.
void data_prox(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               std::span<float> v) noexcept;

/// A video that sensors share, x = v + step A^T dual, with the duals of one of them: a number for
/// each exposure, at its last voxel.
struct DualVideo {
    std::span<float> v;  ///< x
    std::span<float> dual;
};

/// The same map for one of several sensors, after its last result has been taken out of x: the
/// maximum of the dual problem over the duals of this sensor, the others held. Changes x.v and
/// x.dual.
void data_prox(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               const DualVideo& x) noexcept;

/// Adds the part of a sensor, step A^T dual, to x.v.
void add_duals(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               const DualVideo& x) noexcept;

/// argmin_z |z| + (z - v)^2 / (2 threshold)
[[nodiscard]] inline float soft_threshold(float v, float threshold) noexcept {
    return v > 0 ? std::max(v - threshold, 0.0F) : std::min(v + threshold, 0.0F);
}

/// argmin_z max(-z, 0) + (z - v)^2 / (2 threshold), for saturated samples, which light may exceed:
/// Eq. 6 of Portz et al. 2013 with 1 / rho = threshold.
[[nodiscard]] inline float one_sided_soft_threshold(float v, float threshold) noexcept {
    return v > 0 ? v : std::min(v + threshold, 0.0F);
}

}  // namespace stipple
