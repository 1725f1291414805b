#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "decoder/best/patch_matching.h"

namespace stipple {

// Kernels on patches of kPatchSide x kPatchSide; every SIMD target gives the same bits.

/// Sum of squared differences between the patch at `reference` and those at image + at[i]; rows are
/// `cols` values apart. Two values after each row of a patch are read but do not count.
void squared_differences(const float* image, const float* reference,
                         std::span<const std::uint32_t> at, std::ptrdiff_t cols,
                         float* result) noexcept;

/// One group of patches in one plane. The pointers are to the first voxel of the reference patch.
struct GroupFrames {
    const float* noisy = nullptr;
    const float* pilot = nullptr;
    float* sum = nullptr;     ///< takes the weighted values of the filtered patches
    float* weight = nullptr;  ///< takes their weights
    std::ptrdiff_t cols = 0;
    std::array<std::ptrdiff_t, kGroupPatches> patch = {};  ///< offsets, in voxels
};

/// Wiener filter of a group in the DCT of its patches (orthonormal, type II) times the Haar
/// transform along it: a coefficient is multiplied by p^2 / (p^2 + sigma^2), p that of the pilot.
/// Each patch is added with the weight 1 / max(1, sum of the squared factors), times a window that
/// falls towards the border of a patch. (Dabov et al., IEEE TIP 16(8), 2007.)
void filter_group(const GroupFrames& group, float sigma) noexcept;

/// The same patches in three planes.
using ColourGroupFrames = std::array<GroupFrames, 3>;

/// The same of three planes at once, with the colours of the group turned to the axes along which
/// those of the pilot vary independently: an edge between two colours is in one of them alone. One
/// weight for all planes.
void filter_group(const ColourGroupFrames& planes, float sigma) noexcept;

}  // namespace stipple
