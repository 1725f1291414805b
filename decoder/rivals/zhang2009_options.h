#pragma once

namespace stipple {

class Config;

/// Options of the method `zhang2009`; docs/decoder_rivals.md has the formulas.
struct Zhang2009Options {
    int reach_frames = 5;      ///< of the flow that a patch follows, before and after
    int patch_px = 6;          ///< side of a patch
    int step_px = 3;           ///< between reference patches
    float max_distance = 3;    ///< mean square difference to the reference, in noise variances
    int min_confidence = 100;  ///< of the flow, 0..255
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Zhang2009Options& options);

}  // namespace stipple
