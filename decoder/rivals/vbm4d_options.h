#pragma once

namespace stipple {

class Config;

/// Options of the method `vbm4d`; docs/decoder_rivals.md has the formulas.
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

}  // namespace stipple
