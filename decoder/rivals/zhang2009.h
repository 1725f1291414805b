#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/progress_callback.h"
#include "decoder/rivals/frame_decoding.h"
#include "decoder/rivals/zhang2009_options.h"

namespace stipple {

/// Denoising along optical flow: the patches that the flow leads to are a stack, whose principal
/// components above the noise are kept (Zhang, Vaddadi, Jin, Nayar, CVPR 2009, with the flow of a
/// video for the disparities of views). Frames smaller than a patch are not filtered. The same bits
/// for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> denoise_along_flow(
    const DeliveredFrames& frames, const Zhang2009Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
