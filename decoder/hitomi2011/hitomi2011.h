#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/hitomi2011/hitomi2011_options.h"
#include "decoder/progress_callback.h"

namespace stipple {

struct Measurements;

/// Hitomi, Gu, Gupta, Mitsunaga, Nayar, ICCV 2011: orthogonal matching pursuit codes the samples of
/// each space-time patch by a learned dictionary, and overlapping patches are averaged. Voxels of
/// patches without samples are those of the nearest samples. The result may be slightly negative.
/// Returns nothing if `progress` has stopped it. The same bits for any number of threads.
/// \throws InputError without a dictionary, or if its patches are shorter than all exposures.
[[nodiscard]] std::optional<FluxVideo> decode_hitomi2011(
    const Measurements& measurements, const Hitomi2011Options& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
