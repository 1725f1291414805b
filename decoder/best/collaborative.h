#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/best/collaborative_options.h"
#include "decoder/progress_callback.h"

namespace stipple {

class SampleNoise;
struct Measurements;

/// Decodes one block: the estimate of `decode_motion_tv`, then iterations of collaborative filter
/// and proximal map of the data term, which is half-quadratic splitting with a denoiser as its
/// prior (Venkatakrishnan et al., GlobalSIP 2013; Danielyan et al., IEEE TIP 21(4), 2012). A frame
/// smaller than a patch keeps the start estimate. Changes the sums of `measurements` during the
/// call. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_collaborative(
    Measurements& measurements, const SampleNoise& noise, const CollaborativeOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
