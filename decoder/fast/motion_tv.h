#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/fast/total_variation.h"
#include "decoder/motion/motion.h"

namespace stipple {

class Config;
class SampleNoise;
struct Measurements;

/// Options for a mosaic of colours. It has a third of the samples, so the weight of the prior is
/// smaller; changes of colour between pixels have a larger weight, because they are mostly wrong.
struct MosaicTvOptions {
    float spatial_weight = 1.8F;  ///< instead of that along motion
    float chroma_weight = 2;
    int last_iterations = 60;
};

/// The method `fast`; the values were found on natural and high-speed footage
/// (docs/notes/decoder_experiments.md).
struct MotionTvOptions {
    /// Static total variation, without motion: motion is first estimated in its result.
    TotalVariationOptions static_tv{.iterations = 20, .spatial_weight = 20, .temporal_weight = 4};
    /// Total variation along motion, once per round.
    TotalVariationOptions along_motion{.iterations = 8};
    int rounds = 3;
    int last_iterations = 26;  ///< of the last round, instead of `along_motion.iterations`
    MosaicTvOptions mosaic;
    float step = 0.005F;  ///< primal step size at `step_flux`, flux^2
    float step_flux = 0.3F;
    float max_step_ratio = 2;  ///< links to pixels whose step size is larger by more are cut
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, MotionTvOptions& options);

/// Decodes one block. Pseudo-samples are added for voxels that no sample determines
/// (pseudo_samples.h). Static total variation follows, then rounds of variances, motion, and
/// total variation along motion, each from the estimate of the previous round. The result may be
/// slightly negative. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_motion_tv(
    Measurements& measurements, const SampleNoise& noise, const MotionTvOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
