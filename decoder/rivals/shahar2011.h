#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/rivals/frame_octave.h"

namespace stipple {

class Config;
struct BlockTask;

/// Options of the method `shahar2011`; docs/decoder_rivals.md has the formulas.
struct Shahar2011Options {
    int octaves = 2;  ///< at most; the last one has a period of one slot
    OctaveOptions octave = {};
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Shahar2011Options& options);

/// Space-time super-resolution from a single video by self-similarity (Shahar, Faktor, Irani, CVPR
/// 2011), in time: the frames as delivered, twice as many in each octave, then interpolated along
/// motion to the slots that are left, and what the frames lack. Frames at uneven distances are
/// interpolated only. Without any sample the video is black. \throws InputError if the samples are
/// not those of frames. Returns nothing if the progress callback has stopped it.
[[nodiscard]] std::optional<FluxVideo> super_resolve_time(const BlockTask& block,
                                                          const Shahar2011Options& options);

}  // namespace stipple
