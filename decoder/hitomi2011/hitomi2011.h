#pragma once

#include <optional>
#include <string>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/hitomi2011/patch_dictionary.h"

namespace stipple {

class Config;
struct Measurements;

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

/// Hitomi, Gu, Gupta, Mitsunaga, Nayar, ICCV 2011: orthogonal matching pursuit codes the samples of
/// each space-time patch by a learned dictionary, and overlapping patches are averaged. Voxels of
/// patches without samples are those of the nearest samples. The result may be slightly negative.
/// Returns nothing if `progress` has stopped it. The same bits for any number of threads.
/// \throws InputError without a dictionary, or if its patches are shorter than all exposures.
[[nodiscard]] std::optional<FluxVideo> decode_hitomi2011(
    const Measurements& measurements, const Hitomi2011Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
