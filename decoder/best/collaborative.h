#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/best/denoiser.h"
#include "decoder/best/patch_matching.h"
#include "decoder/fast/motion_tv.h"

namespace stipple {

class Config;
class SampleNoise;
struct Measurements;

/// Options for a mosaic of colours. The filter alone fills two of three voxels, which takes more
/// iterations, and a stronger filter in the first ones. The first iterations match patches nearby
/// instead of in other slots, where a static object has the same filters of the array.
struct MosaicFilterOptions {
    int iterations = 60;
    float first_sigma = 0.2F;
    int near_iterations = 6;
    MatchingOptions near{.slots = 2, .own_radius = 8, .path_radius = 2};
};

/// Options for samples without noise (Calibration::noise_free). The filter ends below any shot
/// noise, and all residuals are fed back. Footage of such streams is mostly video after the power
/// 1/2.2, in which the offset weakens the square root; docs/notes/sci_benchmark.md has the effect.
struct NoiseFreeFilterOptions {
    int iterations = 100;
    float first_sigma = 0.12F;
    float min_sigma = 0.008F;
    float light_offset = 0.5F;
};

/// Options for frames of one slot, one sample a pixel: each sample is the light of a voxel with its
/// noise, so that all that is left is to take the noise out. The filter assumes the last sigma in
/// all iterations, and the data-consistency step follows the samples.
struct DirectFilterOptions {
    int iterations = 8;
    int match_every = 3;  ///< iterations, of motion too
    int patch_stride = 3;
    float data_step = 2.5F;
};

/// The method `best`; the values were found on natural and high-speed footage
/// (docs/notes/decoder_experiments.md).
struct CollaborativeOptions {
    MotionTvOptions start = {};
    int iterations = 28;
    int motion_every = 12;  ///< iterations
    int match_every = 6;    ///< iterations
    int patch_stride = 5;   ///< pixels between reference patches, 1..6
    MatchingOptions matching = {};
    /// Standard deviation of the noise that the filter assumes, on the scale 2 sqrt(light). It
    /// falls geometrically from the first iteration to the last. The unit of `last_noise` is the
    /// shot noise of one slot, 1/sqrt(electrons_per_unit); the last value is at least `min_sigma`.
    float first_sigma = 0.13F;
    float last_noise = 1.1F;
    float min_sigma = 0.01F;
    /// Minimum of the offset that is added before the square root, flux; larger if read noise is
    /// large.
    float light_offset = 0.002F;
    float offset_slots = 32;  ///< length of the exposure whose read noise sets the offset
    float min_light = 0;      ///< minimum of the light, flux; at least -offset
    /// Residual feedback: r <- decay r + gain part (y - A x), the part by residual_part;
    /// y + r replaces the samples y.
    float residual_gain = 0.25F;
    float residual_decay = 0.9F;
    float data_step = 1;    ///< step size of the data-consistency step / (sigma^2 (x + offset))
    float momentum = 0.6F;  ///< beta of x + beta (x - x_previous)
    MosaicFilterOptions mosaic = {};
    DirectFilterOptions direct = {};
    NoiseFreeFilterOptions noise_free = {};
};

/// The options that take the place of `options` for frames of one slot, one sample a pixel.
[[nodiscard]] CollaborativeOptions for_direct_samples(CollaborativeOptions options);

/// The options that take the place of `options` for samples without noise.
[[nodiscard]] CollaborativeOptions without_noise(CollaborativeOptions options);

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, CollaborativeOptions& options);

/// The samples of one block. Their sums are changed during a call.
struct SplittingTask {
    Measurements& measurements;
    const SampleNoise& noise;
    const ProgressCallback& progress;
    FluxVideo* start = nullptr;       ///< receives the start estimate
    FluxVideo* noise_gain = nullptr;  ///< receives that of `filter_groups`, if it was called
};

/// Decodes one block: the estimate of `decode_motion_tv`, then iterations of denoiser and proximal
/// map of the data term, which is half-quadratic splitting with a denoiser as its prior
/// (Venkatakrishnan et al., GlobalSIP 2013; Danielyan et al., IEEE TIP 21(4), 2012). Returns
/// nothing if `progress` has stopped it. \throws what the denoiser throws.
[[nodiscard]] std::optional<FluxVideo> decode_by_splitting(const SplittingTask& task,
                                                           const CollaborativeOptions& options,
                                                           const DenoiserMaker& denoiser);

/// The same with the collaborative filter (patch_denoiser.h) as the denoiser. A frame smaller than
/// a patch keeps the start estimate.
[[nodiscard]] std::optional<FluxVideo> decode_collaborative(const SplittingTask& task,
                                                            const CollaborativeOptions& options);
[[nodiscard]] std::optional<FluxVideo> decode_collaborative(
    Measurements& measurements, const SampleNoise& noise, const CollaborativeOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

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
