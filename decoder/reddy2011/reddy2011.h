#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/progress_callback.h"
#include "decoder/reddy2011/reddy2011_options.h"
#include "decoder/stage_observer.h"

namespace stipple {

struct Measurements;

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
