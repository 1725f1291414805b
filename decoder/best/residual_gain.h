#pragma once

namespace stipple {

struct Measurements;

/// Samples of all sensors for a voxel of the video.
[[nodiscard]] float samples_per_voxel(const Measurements& measurements);

/// The part of the gain of residual feedback for a sample. Feedback restores detail that the filter
/// has taken and that other samples do not show, and returns noise. So all of the gain is used up
/// to one sample for four voxels, and nothing where each voxel has its own sample; and less, down
/// to half of it, where noise is read noise, which the filter does not assume. But where noise
/// exceeds the light, only feedback corrects the bias of means of square roots:
///
///     min(1, (4/3 (1 - m))^2) (1 - d w / 2),    d = dark variance / variance,
///     m samples per voxel,                       w = light^2 / (light^2 + 2 variance)
///
/// `light`: of the sample, by the estimate.
[[nodiscard]] inline float residual_part(float samples_per_voxel, float light, float dark_variance,
                                         float variance) noexcept {
    const float unsampled = samples_per_voxel < 1 ? (1 - samples_per_voxel) / 0.75F : 0;
    const float few = unsampled < 1 ? unsampled * unsampled : 1;
    const float dark = variance > dark_variance ? dark_variance / variance : 1;
    const float square = light * light;
    const float above_noise = square > 0 ? square / (square + 2 * variance) : 0;
    return few * (1 - dark * above_noise / 2);
}

}  // namespace stipple
