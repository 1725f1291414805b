#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/progress_callback.h"
#include "decoder/rivals/frame_decoding.h"
#include "decoder/rivals/vbm4d_options.h"

namespace stipple {

/// Collaborative filter of spatio-temporal volumes, after V-BM4D (Maggioni, Boracchi, Foi,
/// Egiazarian, IEEE TIP 21(9), 2012), of frames after a variance-stabilising transform: volumes of
/// blocks along motion, groups of similar volumes, hard thresholding in a 4-D transform, then a
/// Wiener filter with the result as pilot. Frames smaller than a block are not filtered. The same
/// bits for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> filter_volumes(
    const DeliveredFrames& frames, const Vbm4dOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
