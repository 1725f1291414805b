#pragma once

#include "decoder/rivals/frame_octave.h"

namespace stipple {

class Config;

/// Options of the method `shahar2011`; docs/decoder_rivals.md has the formulas.
struct Shahar2011Options {
    int octaves = 2;  ///< at most; the last one has a period of one slot
    OctaveOptions octave = {};
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Shahar2011Options& options);

}  // namespace stipple
