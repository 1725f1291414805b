#pragma once

namespace stipple {

struct Measurements;

/// Samples of all sensors for a voxel of the video.
[[nodiscard]] float samples_per_voxel(const Measurements& measurements);

/// The part of the gain of residual feedback for a sample. Feedback restores detail that the filter
/// has taken and that other samples do not show, and returns noise. So all of the gain is used up
/// to one sample for four voxels, and nothing where each voxel has its own sample; and half of it
/// where all noise is read noise, which the filter does not assume:
///
///     min(1, (4/3 (1 - m))^2) (1 + s) / 2,
///     m samples per voxel, s = 1 - dark variance / variance
[[nodiscard]] inline float residual_part(float samples_per_voxel, float dark_variance,
                                         float variance) noexcept {
    const float unsampled = samples_per_voxel < 1 ? (1 - samples_per_voxel) / 0.75F : 0;
    const float few = unsampled < 1 ? unsampled * unsampled : 1;
    const float shot = variance > dark_variance ? 1 - dark_variance / variance : 0;
    return few * (1 + shot) / 2;
}

}  // namespace stipple
