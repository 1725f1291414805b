#pragma once

#include <cstddef>
#include <vector>

#include "core/flux_video.h"

namespace stipple {

class SampleNoise;
struct Measurements;

/// During the life of this object the measurements contain pseudo-samples for voxels that no
/// sample determines: in slots outside all exposures, in closed slots of exposures, and in
/// saturated exposures. Otherwise the prior alone would decide there, and small bright objects
/// would fade into their surroundings.
/// - A voxel in no sample becomes a sample of its own. At the ends of the block this holds only if
///   the site has gaps, within an exposure only if all sites are closed in this slot; otherwise
///   open sites around it have more information.
/// - A saturated sample becomes an ordinary sample if the unsaturated neighbours in time are
///   brighter than its bound. If all samples of a site are saturated, the bound of each becomes the
///   highest of them.
/// The light of pseudo-samples is that of `nearest` (nearest_samples.h). Its variance is the
/// variance of a sample plus a multiple of the squared change between successive samples of a site;
/// this change is averaged over the 7 x 7 sites around and reduced by the part of the noise. So
/// they have little influence on moving objects. Streams with two exposures of a pixel at once have
/// no voxel without a sample, and none is added. Of several sensors a voxel counts as sampled if
/// one of them has a sample of it; saturated samples remain bounds, as other sensors have the
/// light. The pseudo-samples become those of the first sensor. The same bits for any thread count.
class PseudoSamples {
  public:
    PseudoSamples(Measurements& measurements, const FluxVideo& nearest, const SampleNoise& noise);
    /// Restores the measurements, except their variances.
    ~PseudoSamples();
    PseudoSamples(const PseudoSamples&) = delete;
    PseudoSamples& operator=(const PseudoSamples&) = delete;

    /// The sum of a saturated sample before the change.
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
