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

/// One pixel's share in the distance of two patches.
struct SampleDifference {
    float error = 0;   ///< sum of weight (y - z)^2
    float weight = 0;  ///< sum of cover / (1 + variance of z)
    int cover = 0;     ///< slots of the patch that were compared
};

/// A site, and the slot that the patch begins in.
struct SiteInPatch {
    std::size_t site = 0;
    int slot = 0;
};

/// Compares the samples of two pixels over the `slots` slots of a patch (Portz et al. 2013, Fig.
/// 2). In each slot the longer of the two samples, or of two equal ones the one that covers more of
/// the patch, is the target y, once each; the other pixel's samples over the target's exposure are
/// blurred to it:
///     z = sum_k o_k / n_k y_k,   variance of z = sum_k (o_k / n_k)^2,
/// with n_k the open slots of sample k, o_k those that the target shares. The target counts with
/// weight c / (1 + variance), c its open slots in the patch. Where the target is saturated and z
/// >= y, or one of the y_k is and z <= y, the error is 0; where both are, nothing is compared, nor
/// where z is not known for the whole target.
[[nodiscard]] SampleDifference compare_samples(const ExposureTable& table, const SiteInPatch& first,
                                               const SiteInPatch& second, int slots) noexcept;

/// The mean error of two patches, all planes together, in flux^2: of patches of the same light one
/// to three times the variance of a sample. Infinite if less than an eighth of the patch can be
/// compared, or as soon as it is certain to exceed `bound`. Precondition: both lie in the block.
[[nodiscard]] float patch_distance(const ExposureTable& table, const PatchSize& size,
                                   const PatchPosition& reference, const PatchPosition& other,
                                   float bound) noexcept;

}  // namespace stipple
