#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/flux_video.h"
#include "decoder/best/patch_matching.h"

namespace stipple {

// Kernels on patches of kPatchSide x kPatchSide; every SIMD target gives the same bits.

/// Sums of squared differences between the patch at `reference` and the patches at image + at[i];
/// rows are `cols` values apart. Reads two values after each row of a patch, which do not count.
void squared_differences(const float* image, const float* reference,
                         std::span<const std::uint32_t> at, std::ptrdiff_t cols,
                         float* result) noexcept;

/// One group of patches in one plane. The pointers are to the first voxel of the reference patch.
struct GroupFrames {
    const float* noisy = nullptr;
    const float* pilot = nullptr;
    float* sum = nullptr;     ///< receives the weighted values of the filtered patches
    float* weight = nullptr;  ///< receives their weights
    float* window = nullptr;  ///< receives their windows, unless it is null
    std::ptrdiff_t cols = 0;
    std::array<std::ptrdiff_t, kGroupPatches> patch = {};  ///< offsets, in voxels
};

/// Wiener filter of a group in the DCT of its patches (orthonormal, type II) times the Haar
/// transform along the group: multiplies a coefficient by p^2 / (p^2 + sigma^2), where p is that of
/// the pilot. Adds each patch with the weight 1 / max(1, sum of the squared factors), times a
/// window that decreases towards the border of a patch. (Dabov et al., IEEE TIP 16(8), 2007.)
void filter_group(const GroupFrames& group, float sigma) noexcept;

/// The same patches in three planes.
using ColourGroupFrames = std::array<GroupFrames, 3>;

/// Filters a group in three planes, after rotating its colours to the principal axes of the pilot's
/// colours: an edge between two colours then appears in one plane only. One weight for all planes.
void filter_group(const ColourGroupFrames& planes, float sigma) noexcept;

/// A 3 x 3 matrix by rows.
using ColourMatrix = std::array<std::array<float, 3>, 3>;

/// Principal axes of colours with this covariance: its eigenvectors, orthonormal, one per column,
/// by increasing variance. The same bits everywhere, because it uses square roots and the four
/// operations only. Precondition: symmetric, finite.
[[nodiscard]] ColourMatrix principal_colour_axes(const ColourMatrix& covariance) noexcept;

/// What `filter_groups` writes.
struct FilteredVideo {
    FluxVideo& filtered;
    /// Unless it is null, receives for each voxel the number of coefficients of a patch that the
    /// filter has kept, 1 to 576: the sum of the squared factors of a group in one plane, as the
    /// harmonic mean of its groups. It is in proportion to the noise that is left in them.
    FluxVideo* noise_gain = nullptr;
};

/// Filters all groups of similar patches of `noisy` by the Wiener filter of `filter_group`; three
/// planes are filtered together, other numbers of planes one by one. `pilot` is an estimate of
/// `noisy` without noise. A voxel becomes the weighted mean over all its patches. `sigma` is the
/// standard deviation of the noise, equal everywhere. The same bits for any thread count and SIMD
/// target. Precondition: the videos have one shape, and the groups belong to it.
void filter_groups(const FluxVideo& noisy, const FluxVideo& pilot, const PatchGroups& groups,
                   float sigma, const FilteredVideo& result);

}  // namespace stipple
