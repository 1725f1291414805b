#pragma once

#include "core/flux_video.h"
#include "decoder/best/patch_matching.h"

namespace stipple {

/// Filters all groups of similar patches of `noisy` by the Wiener filter of `filter_group`; three
/// planes are filtered together, other numbers of planes one by one. `pilot` is an estimate of
/// `noisy` without noise. A voxel becomes the weighted mean over all its patches. `sigma` is the
/// standard deviation of the noise, equal everywhere. The same bits for any thread count and SIMD
/// target. Precondition: the videos have one shape, and the groups belong to it.
void filter_groups(const FluxVideo& noisy, const FluxVideo& pilot, const PatchGroups& groups,
                   float sigma, FluxVideo& filtered);

}  // namespace stipple
