#pragma once

#include <cstddef>

#include "decoder/portz2013/exposure_table.h"

namespace stipple {

/// Size of a space-time patch.
struct PatchSize {
    int rows = 6;
    int cols = 6;
    int slots = 4;
};

/// First slot, row and column of a patch in its block.
struct PatchPosition {
    int slot = 0;
    int row = 0;
    int col = 0;
};

/// Contribution of one pixel to the distance of two patches.
struct SampleDifference {
    float error = 0;   ///< sum of weight (y - z)^2
    float weight = 0;  ///< sum of cover / (1 + variance of z)
    int cover = 0;     ///< compared slots of the patch
};

/// A site and the first slot of the patch.
struct SiteInPatch {
    std::size_t site = 0;
    int slot = 0;
};

/// Compares the samples of two pixels over the `slots` slots of a patch (Portz et al. 2013, Fig.
/// 2). In each slot the longer of the two samples is the target y; of two equal ones it is the one
/// with more slots in the patch. Each target counts once. The samples of the other pixel during the
/// target's exposure are blurred to it:
///     z = sum_k o_k / n_k y_k,   variance of z = sum_k (o_k / n_k)^2,
/// where n_k are the open slots of sample k and o_k those that it shares with the target. With
/// weights, n_k is the sum of the weights of sample k, and o_k that of the target's weights. The
/// weight of the target is c / (1 + variance), where c is the number of its open slots in the
/// patch. The error is 0 if the target is saturated and z >= y, or if one of the y_k is saturated
/// and z <= y. Nothing is compared if both are saturated, or if z is not known for the whole
/// target.
[[nodiscard]] SampleDifference compare_samples(const ExposureTable& table, const SiteInPatch& first,
                                               const SiteInPatch& second, int slots) noexcept;

/// Mean error of two patches over all planes, in flux^2: for patches of the same light one to three
/// times the variance of a sample. Infinite if less than an eighth of the patch can be compared, or
/// as soon as it must exceed `bound`. Precondition: both patches lie in the block.
[[nodiscard]] float patch_distance(const ExposureTable& table, const PatchSize& size,
                                   const PatchPosition& reference, const PatchPosition& other,
                                   float bound) noexcept;

}  // namespace stipple
