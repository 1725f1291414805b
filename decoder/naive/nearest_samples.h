#pragma once

#include "core/flux_video.h"

namespace stipple {

struct Measurements;

/// The estimate that knows nothing of the scene, and the start of all others: each voxel is the
/// weighted mean of the light per slot of its own exposure and of the shorter ones around it, or,
/// where it is in none, of all around it. An exposure of n open slots that is d slots away weighs
/// exp(-d / 1.5) / (0.3 + n). A saturated exposure does not count, but where it is a voxel's own
/// the mean does not fall below it, and where all within 8 slots are saturated the estimate is the
/// highest of them. So the frames of a conventional camera are held while it is exposing, and
/// interpolated while it is not. What has no sample at
/// all, as two of the three colours of a pixel under a colour filter, is filled from around it
/// (unsampled_sites.h); without any sample the video is 0.
[[nodiscard]] FluxVideo nearest_samples(const Measurements& measurements);

}  // namespace stipple
