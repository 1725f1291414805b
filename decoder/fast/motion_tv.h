#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/fast/total_variation.h"
#include "decoder/motion/motion.h"
#include "decoder/progress_callback.h"

namespace stipple {

class Config;
class SampleNoise;
struct Measurements;

/// What is different where the planes are a mosaic of colours: a third of the samples, so the prior
/// weighs less, but colours that change from pixel to pixel are hardly true.
struct MosaicTvOptions {
    float spatial_weight = 1.8F;  ///< along motion
    float chroma_weight = 2;
    int last_iterations = 60;
};

/// The method `fast`; the values were found on natural and high-speed footage
/// (docs/notes/decoder_experiments.md).
struct MotionTvOptions {
    /// The estimate in which motion is first searched: static total variation, without motion.
    TotalVariationOptions static_tv{.iterations = 20, .spatial_weight = 20, .temporal_weight = 4};
    /// Along motion, once a round.
    TotalVariationOptions along_motion{.iterations = 8};
    int rounds = 3;
    int last_iterations = 26;  ///< of the last round, instead of those of `along_motion`
    MosaicTvOptions mosaic;
    float step = 0.005F;  ///< primal step at `step_flux`, flux^2
    float step_flux = 0.3F;
    float max_step_ratio = 2;  ///< links to pixels with a step larger by more are cut
};

/// Decodes one block: what the nearest samples say of light that no sample knows is presumed
/// (presumed_samples.h); then static total variation, then rounds of (variances, motion, total
/// variation along it), each from the estimate of the last. The result may be slightly negative.
/// Nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_motion_tv(
    Measurements& measurements, const SampleNoise& noise, const MotionTvOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

/// The keys of docs/decoder_options.md. \throws InputError as Config.
void read_options(Config& config, MotionTvOptions& options);

}  // namespace stipple
