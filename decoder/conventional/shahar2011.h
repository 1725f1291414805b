#pragma once

#include <cstdint>
#include <optional>

#include "core/flux_video.h"

namespace stipple {

class Config;
struct BlockTask;

/// How frames become twice as many.
enum class Octave : std::uint8_t {
    kSplit,   ///< gapless exposures: each becomes two of half the length
    kInsert,  ///< exposures with gaps: a frame of the same length between two
};

struct OctaveOptions {
    int patch_px = 5;           ///< side of a space-time patch
    int step_px = 2;            ///< between patches; patch_px at most counts
    int search_px = 8;          ///< search radius
    int search_frames = 4;      ///< before and after
    int examples = 6;           ///< of a patch
    float match_sigma = 0.03F;  ///< of differences on the scale 2 sqrt(light), beside noise
    float start_weight = 0.2F;  ///< of the interpolated estimate, in examples
};

/// Temporal super-resolution by a factor of 2 from the frames themselves (Shahar, Faktor, Irani,
/// CVPR 2011). The frames are made coarser in time, as a camera of twice the period would have
/// taken them; also after halving their size, which halves velocities. Where a patch of the frames
/// is similar to one of the coarse frames, the finer frames of the latter are an example of what
/// the former looks like. Examples are averaged with the frames interpolated along motion.
/// kSplit: 2 n frames, whose pairs have the given frames as their means; kInsert: 2 n - 1 frames,
/// every other one a given frame. `per_light` is the variance of noise per light. The same bits for
/// any thread count. Precondition: at least one frame.
[[nodiscard]] FluxVideo upsampled_frames(const FluxVideo& frames, Octave octave, float per_light,
                                         const OctaveOptions& options);

/// Options of the method `shahar2011`; docs/decoder_conventional.md has the formulas.
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
