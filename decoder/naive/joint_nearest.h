#pragma once

#include "core/flux_video.h"

namespace stipple {

struct Measurements;

/// `nearest_samples` of several sensors (Measurements::others). Each voxel is the weighted mean of
/// the light per slot of the exposures of all sensors that include its slot, and of shorter ones
/// around it; a voxel without an exposure takes all around. The weight of an exposure with n open
/// slots, d slots away, is exp(-d / 1.5) / ((0.3 + n) n var), var the variance of its light per
/// slot: n var does not depend on n where shot noise prevails, so that sensors count by their
/// photons. Saturated exposures have no weight, but if all that include the slot are saturated, the
/// mean is at least their highest bound.
[[nodiscard]] FluxVideo joint_nearest_samples(const Measurements& measurements);

}  // namespace stipple
