#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"
#include "decoder/stage_observer.h"

namespace stipple {

class Config;
struct Measurements;

/// Options of the method `reddy2011`. docs/decoder_published.md says which values the paper gives.
struct Reddy2011Options {
    int levels = 3;                 ///< of the wavelet transform, at most
    float wavelet_weight = 0.004F;  ///< lambda, flux
    float first_weight = 0.1F;      ///< lambda of the first iteration without flow
    float flow_weight = 1;          ///< beta
    float min_confidence = 0.6F;    ///< of the flow; exp(-1/2) is an inconsistency of 1 pixel
    int first_iterations = 100;     ///< without flow
    int rounds = 3;                 ///< of flow and minimisation along it
    int iterations = 60;            ///< in each round
};

/// The keys of `stipple list keys decoder`. \throws InputError as Config.
void read_options(Config& config, Reddy2011Options& options);

/// P2C2 (Reddy, Veeraraghavan, Chellappa, CVPR 2011): frames that are sparse in the wavelet domain,
/// first without flow, then with brightness constancy where the flow of the estimate is consistent
/// (sparse_frames.h). Observed stages: `start` (nearest samples), `without_flow`, `round1` and so
/// on. The result may be slightly negative. Returns nothing if `progress` has stopped it. The same
/// bits for any number of threads.
[[nodiscard]] std::optional<FluxVideo> decode_reddy2011(
    const Measurements& measurements, const Reddy2011Options& options,
    const StageObserver& observer = {},
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
