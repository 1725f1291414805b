#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/block_task.h"

namespace stipple {

class SampleNoise;

/// Arguments of a method with a prior on the video.
struct PriorTask {
    Measurements& measurements;
    const SampleNoise& noise;
    const DecodeOptions& options;
    const ProgressCallback& progress;
};

/// Decodes a block by such a method, after the samples of stuck pixels are removed. If all pixels
/// have the same exposures, as in a conventional camera (one sensor), `decode` restores the frames,
/// and the video is interpolated between them.
[[nodiscard]] std::optional<FluxVideo> decode_with_prior(
    const BlockTask& block, std::optional<FluxVideo> (*decode)(const PriorTask& task));

}  // namespace stipple
