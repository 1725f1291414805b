#pragma once

#include <cstddef>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

class SampleNoise;
struct Measurements;

/// While it lives, measurements hold what the samples of a site say of its light where none of
/// them knows it: in slots outside all exposures, in their closed slots, and in saturated
/// exposures. Without that the prior alone decides there, and small bright things sink to the light
/// around them.
///  - A voxel in no sample becomes a sample of its own; at the ends only if the site has gaps, and
///    within an exposure only if all sites are closed in that slot, for else those around it that
///    are open know more.
///  - A saturated sample becomes one like others if its neighbours in time that are not saturated
///    are brighter than its bound; if all are saturated, its bound becomes the highest of them.
/// The light is that of `nearest` (nearest_samples.h). The variance is that of a sample, and a
/// multiple of the squared change of light from one sample of a site to the next, averaged over
/// the 7 x 7 sites around it, less what noise alone changes: little is presumed of what moves.
/// Streams with two exposures of a pixel under way have no voxel without a sample, and none is
/// added. The same bits for any thread count.
class PresumedSamples {
  public:
    PresumedSamples(Measurements& measurements, const FluxVideo& nearest, const SampleNoise& noise);
    /// Leaves the measurements as they were, but for their variances.
    ~PresumedSamples();
    PresumedSamples(const PresumedSamples&) = delete;
    PresumedSamples& operator=(const PresumedSamples&) = delete;

    /// The sum of a saturated sample before it was changed.
    struct Bound {
        std::size_t voxel;
        float sum;
    };

  private:
    Measurements& measurements_;
    bool interleaved_;
    std::vector<Bound> bounds_;
};

}  // namespace stipple
