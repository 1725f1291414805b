#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/block_matching.h"
#include "decoder/checkpoint.h"
#include "decoder/motion_tv.h"

namespace stipple {

class SampleNoise;
struct Measurements;

/// What is different where the planes are a mosaic of colours: two of three voxels are filled by
/// the filter alone, which takes more iterations and stronger ones at first. In those it looks for
/// similar blocks nearby rather than in other slots, where a thing at rest is under the same
/// filters of the array.
struct MosaicFilterOptions {
    int iterations = 60;
    float first_sigma = 0.2F;
    int near_iterations = 6;
    MatchingOptions near{.slots = 2, .own_radius = 8, .path_radius = 2};
};

/// The method `best`; the values were found on natural and high-speed footage
/// (docs/notes/decoder_experiments.md).
struct CollaborativeOptions {
    MotionTvOptions start = {};
    int iterations = 28;
    int motion_every = 12;  ///< iterations
    int match_every = 6;    ///< iterations
    int block_step = 5;     ///< pixels between reference blocks, 1..6
    MatchingOptions matching = {};
    /// Standard deviation that the filter takes for noise, on the scale 2 sqrt(light): falls
    /// geometrically from the first iteration to the last. The last is in shot noise of one slot,
    /// 1 / sqrt(electrons_per_unit), but not below `least_sigma`.
    float first_sigma = 0.13F;
    float last_noise = 1.1F;
    float least_sigma = 0.01F;
    /// Flux that is added before the square root, at least; more where read noise is larger.
    float light_offset = 0.002F;
    float offset_slots = 32;  ///< of an exposure whose read noise sets that offset
    float least_light = 0;    ///< flux; what noise makes less counts as that, at least -offset
    /// Share of the samples' residuals that is added to them, and what is kept of that in the next
    /// iteration.
    float feedback = 0.25F;
    float feedback_kept = 0.9F;
    float momentum = 0.6F;  ///< share of the last step of the estimate that is taken again
    MosaicFilterOptions mosaic = {};
};

/// Decodes one block: the estimate of `decode_motion_tv`, then iterations of (collaborative filter,
/// proximal map of the data term), half-quadratic splitting with a denoiser as its prior
/// (Venkatakrishnan et al., GlobalSIP 2013; Danielyan et al., IEEE TIP 21(4), 2012). A frame too
/// small for blocks stays as the start has left it. Changes the sums of `measurements` meanwhile.
/// Nothing if `checkpoint` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_collaborative(
    Measurements& measurements, const SampleNoise& noise, const CollaborativeOptions& options,
    const Checkpoint& checkpoint = [](double) { return true; });

}  // namespace stipple
