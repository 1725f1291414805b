#pragma once

#include <cstdint>

#include "core/flux_video.h"

namespace stipple {

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
[[nodiscard]] FluxVideo doubled_frames(const FluxVideo& frames, Octave octave, float per_light,
                                       const OctaveOptions& options);

}  // namespace stipple
