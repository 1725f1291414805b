#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/progress_callback.h"
#include "decoder/rivals/bennett2005_options.h"
#include "decoder/rivals/frame_decoding.h"

namespace stipple {

/// Adaptive spatio-temporal accumulation (Bennett and McMillan, SIGGRAPH 2005): each pixel
/// accumulates the same pixel of other frames by a bilateral filter that compares neighbourhoods.
/// A pixel that finds fewer samples than it needs accumulates its spatial neighbours too. Weights
/// depend on the noise of the frames. The same bits for any thread count. Returns nothing if
/// `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> accumulate_samples(
    const DeliveredFrames& frames, const Bennett2005Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
