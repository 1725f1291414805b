#pragma once

#include <optional>

#include "core/flux_video.h"
#include "core/progress.h"

namespace stipple {

struct Measurements;

/// The method `live`: decodes one block fast, for a picture while filming. Each eight slots are
/// decoded from a window of the samples from 8 slots before their first one to 15 after it, so that
/// a slot depends on no later sample than those read 15 slots after it. In the window
/// 1. the light of a site is its mean along time (average_in_time);
/// 2. the residuals of the exposures around a pixel change it, slot by slot, at half the resolution
///    (add_coarse_residuals), and then
/// 3. at full resolution in the eight slots (add_fine_residuals);
/// 4. the step of data consistency follows (restore_sums).
/// Each step leaves residuals that may be noise, so that still pixels keep their mean along time.
/// The structure, back projection of smoothed residuals, is that of Irani and Peleg (1991). Sites
/// without any sample are interpolated from their surroundings (fill_unsampled); voxels without a
/// sample in the window become those of nearest_samples, which looks further. Of a colour filter
/// array each colour has its own residuals. The result may be slightly negative. Returns nothing if
/// `progress`, which receives a fraction, has stopped it. Precondition: one sensor.
[[nodiscard]] std::optional<FluxVideo> decode_live(
    const Measurements& measurements,
    const ProgressCallback& progress = [](double) { return true; });

}  // namespace stipple
