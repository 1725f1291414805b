#pragma once

#include <optional>

#include "core/flux_video.h"
#include "decoder/fast/motion_tv_options.h"
#include "decoder/motion/motion.h"
#include "decoder/progress_callback.h"

namespace stipple {

class SampleNoise;
struct Measurements;

/// Decodes one block. Presumed samples are added for voxels that no sample determines
/// (pseudo_samples.h). Static total variation follows, then rounds of variances, motion, and
/// total variation along motion, each from the estimate of the previous round. The result may be
/// slightly negative. Returns nothing if `progress` has stopped it.
[[nodiscard]] std::optional<FluxVideo> decode_motion_tv(
    Measurements& measurements, const SampleNoise& noise, const MotionTvOptions& options,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
