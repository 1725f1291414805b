#pragma once

#include "core/flux_video.h"
#include "decoder/best/patch_matching.h"

namespace stipple {

/// Filters all groups of similar patches of `noisy`, three planes together, others plane by plane,
/// by the Wiener filter of `filter_group` with `pilot`, an estimate of what `noisy` is without
/// noise; a voxel becomes the weighted mean of what the patches that it is in say. `sigma` is the
/// standard deviation of the noise, the same everywhere. The same bits for any thread count and
/// SIMD target. Precondition: the videos have one shape, the groups are of it.
void filter_groups(const FluxVideo& noisy, const FluxVideo& pilot, const PatchGroups& groups,
                   float sigma, FluxVideo& filtered);

}  // namespace stipple
