#pragma once

#include <optional>

#include "core/flux_video.h"

namespace stipple {

struct BlockTask;

/// HDR video of frames whose exposure times alternate (Kang, Uyttendaele, Winder, Szeliski,
/// SIGGRAPH 2003): each frame is merged with the frames before and after it, moved along motion to
/// its time. Weights are inverse variances of the samples, less where the frames contradict each
/// other. Where a frame is saturated, the frames of other exposure times, interpolated along their
/// own motion, take its place; its bound remains. Then the video between the merged frames
/// (frame_exposures.h). The same bits for any thread count. Returns nothing if the progress
/// callback has stopped it. \throws InputError if the samples are not those of frames.
[[nodiscard]] std::optional<FluxVideo> merge_exposure_times(const BlockTask& block);

}  // namespace stipple
