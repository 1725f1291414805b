#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/rivals/shahar2011_options.h"

namespace stipple {

struct BlockTask;

/// Space-time super-resolution from a single video by self-similarity (Shahar, Faktor, Irani, CVPR
/// 2011), in time: the frames as delivered, twice as many in each octave, then interpolated along
/// motion to the slots that are left, and what the frames lack. Frames at uneven distances are
/// interpolated only. Without any sample the video is black. \throws InputError if the samples are
/// not those of frames. Returns nothing if the progress callback has stopped it.
[[nodiscard]] std::optional<FluxVideo> super_resolve_time(const BlockTask& block,
                                                          const Shahar2011Options& options);

}  // namespace stipple
