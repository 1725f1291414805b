#pragma once

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

/// Limits of a run, so that all that belongs to it stays in a core's cache.
inline constexpr std::size_t kMaxRunSites = 256;
inline constexpr int kMaxRunSlots = 128;

/// All sites of a frame, in runs as long as may be.
[[nodiscard]] std::vector<SiteRun> site_runs(FrameShape shape);

/// The proximal map of the data term, in place: the x nearest to v that explains the samples,
///   argmin_x  sum_t (x_t - v_t)^2 / (2 step_t) + sum_k (y_k - (A x)_k)^2 / (2 variance_k),
/// in closed form, since exposures share no voxel: x_t = v_t + step_t (y - sum v) / (variance +
/// sum step). A saturated exposure pulls up only. `v` is all voxels; `step` has one value per
/// slot and pixel, order (slot, row, col), shared by the planes. The same bits for any SIMD target.
/// Precondition: the run lies within one plane; run and slots are within the limits above.
void data_prox(const Measurements& measurements, const SiteRun& run, std::span<const float> step,
               std::span<float> v) noexcept;

}  // namespace stipple
