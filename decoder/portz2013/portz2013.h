#pragma once

#include <cstdint>
#include <optional>

#include "core/flux_video.h"
#include "decoder/portz2013/portz2013_options.h"
#include "decoder/progress_callback.h"
#include "decoder/stage_observer.h"

namespace stipple {

struct Measurements;

/// Maximum number of sites in the core of a tile: a block of 64 slots then needs about 3 GB.
inline constexpr std::int64_t kPortz2013CoreSites = std::int64_t{1} << 16;

/// Random Coded Sampling for High-Speed HDR Video (Portz, Zhang, Jiang, ICCP 2013), Sec. 4. Stage 1
/// explains each patch by the samples of similar patches. Stage 2 repeats this with patches found
/// along motion in the estimate and by search in it. Observed stages: `start` (nearest samples),
/// `stage1`, `stage2`. Memory: 4 bytes per row of the problem, about 490 bytes per voxel. Returns
/// nothing if `progress` has stopped it. The same bits for any number of threads.
[[nodiscard]] std::optional<FluxVideo> decode_portz2013(
    const Measurements& measurements, const Portz2013Options& options,
    const StageObserver& observer = {},
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
