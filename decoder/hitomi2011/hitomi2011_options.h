#pragma once

#include <string>

#include "decoder/hitomi2011/patch_dictionary.h"

namespace stipple {

class Config;

/// Options of the method `hitomi2011`. docs/decoder_published.md says which values the paper gives.
struct Hitomi2011Options {
    std::string dictionary_file;  ///< who reads the options reads it into `dictionary`
    PatchDictionary dictionary;   ///< none: no atoms
    int step_px = 1;              ///< between patches, rows and columns
    int step_slots = 0;           ///< between patches; 0: their length
    int max_atoms = 12;           ///< of a patch
    float noise_factor =
        1.2F;  ///< the pursuit ends at the standard deviation of the noise times this
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Hitomi2011Options& options);

}  // namespace stipple
