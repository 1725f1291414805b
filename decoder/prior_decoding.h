#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/decode_method.h"

namespace stipple {

class SampleNoise;

/// What a method with a prior on the video is given.
struct PriorTask {
    Measurements& measurements;
    const SampleNoise& noise;
    const DecodeOptions& options;
    const ProgressCallback& progress;
};

/// Decodes a block by such a method. Pixels that are stuck are taken out first; where all pixels
/// expose alike, as those of a conventional camera, `decode` restores the frames, and the video is
/// interpolated between them.
[[nodiscard]] std::optional<FluxVideo> decode_with_prior(
    const BlockTask& block, std::optional<FluxVideo> (*decode)(const PriorTask& task));

}  // namespace stipple
