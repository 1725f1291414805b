#pragma once

#include "core/flux_video.h"

namespace stipple {

struct Measurements;

/// The estimate without a model of the scene, and the start of all other methods. Each voxel is the
/// weighted mean of the light per slot of its own exposure and of the shorter exposures of its
/// pixel around it; a voxel without an exposure takes all exposures around. An exposure with n open
/// slots (with weights: whose weights have the sum n) at a distance of d slots has the weight
/// exp(-d / 1.5) / (0.3 + n). A saturated exposure has no weight, but the mean is at least the
/// bound of the voxel's own exposure. If all exposures within 8 slots are saturated, the estimate
/// is their highest bound. So the frames of a conventional camera are held during their exposure
/// and interpolated between exposures. Sites without any sample, such as two of three colours under
/// a colour filter, are interpolated from their surroundings (unsampled_sites.h). Without any
/// sample the video is 0. Of several sensors: joint_nearest.h.
[[nodiscard]] FluxVideo nearest_samples(const Measurements& measurements);

/// exp(-d / 1.5) at a distance of d slots, constant from 16 on. Precondition: d >= 0.
[[nodiscard]] float closeness(int distance_slots) noexcept;

/// Saturated exposures further away are no bound.
inline constexpr int kNearSlots = 8;

}  // namespace stipple
