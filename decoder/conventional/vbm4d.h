#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/conventional/frame_decoding.h"

namespace stipple {

class Config;

/// Options of the method `vbm4d`; docs/decoder_conventional.md has the formulas.
struct Vbm4dOptions {
    int reach_frames = 4;     ///< of a volume, before and after its reference block
    int step_px = 4;          ///< between reference blocks
    int search_px = 5;        ///< search radius of similar volumes
    int max_volumes = 8;      ///< of a group; a power of 2 below is used
    float threshold = 2.7F;   ///< of coefficients in the first stage, in standard deviations
    float max_distance1 = 3;  ///< mean square difference of similar volumes, in noise variances
    float max_distance2 =
        1;  ///< the same in the second stage, where the basic estimate is compared
    int min_confidence = 100;  ///< of the motion of a volume, 0..255
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Vbm4dOptions& options);

/// Collaborative filter of spatio-temporal volumes, after V-BM4D (Maggioni, Boracchi, Foi,
/// Egiazarian, IEEE TIP 21(9), 2012), of frames after a variance-stabilising transform: volumes of
/// blocks along motion, groups of similar volumes, hard thresholding in a 4-D transform, then a
/// Wiener filter with the result as pilot. Frames smaller than a block are not filtered. The same
/// bits for any thread count. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> filter_volumes(
    const DeliveredFrames& frames, const Vbm4dOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
