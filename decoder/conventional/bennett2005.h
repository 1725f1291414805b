#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/conventional/frame_decoding.h"

namespace stipple {

class Config;

/// Options of the method `bennett2005`; docs/decoder_conventional.md has the formulas.
struct Bennett2005Options {
    int reach_frames = 4;           ///< frames before and after that are accumulated
    float range_sigma = 1;          ///< of the excess distance D - 1 of two neighbourhoods
    float target_noise = 0.01F;     ///< sets the samples that a pixel needs, relative to its light
    int max_samples = 16;           ///< that a pixel needs
    int radius_px = 3;              ///< of the spatial filter
    float spatial_sigma_px = 1.5F;  ///< of the spatial filter
    float spatial_range_sigma = 2;  ///< of the spatial filter, in standard deviations of the noise
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Bennett2005Options& options);

/// Adaptive spatio-temporal accumulation (Bennett and McMillan, SIGGRAPH 2005): each pixel
/// accumulates the same pixel of other frames by a bilateral filter that compares neighbourhoods.
/// A pixel that finds fewer samples than it needs accumulates its spatial neighbours too. Weights
/// depend on the noise of the frames. The same bits for any thread count. Returns nothing if
/// `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> accumulate_samples(
    const DeliveredFrames& frames, const Bennett2005Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
