#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "calibration/field_exposure.h"
#include "stream/stream_header.h"

namespace stipple {

/// Mean sample at one level of uniform light, in DN.
struct ResponseLevel {
    /// Number of the unit of `exposure`. The ratios of levels in one unit are known.
    std::size_t scale = 0;
    double exposure = 0;      ///< light x time
    double dark_dn = 0;       ///< mean sample of the same time without light
    double mean_dn = 0;       ///< mean over the sites
    double variance_dn2 = 0;  ///< of mean_dn
    double noise_dn2 = 0;     ///< temporal variance of a sample
};

/// The light of a flat series.
struct LightScale {
    /// Series of light in one unit have one number; those of unknown ratio have others.
    std::size_t number = 0;
    double light_per_s = 1;
};

/// The levels of a flat series of constant light, one for each exposure time, in colour each light
/// group its own; groups have scales of their own. Sites count that have samples at all times and
/// are no outliers. Levels from which on the noise falls, because pixels clip, are left out, and
/// the level before them. `dark` has an exposure. Precondition: the exposures are not linearised.
[[nodiscard]] std::vector<ResponseLevel> response_levels(const StreamHeader& header,
                                                         std::span<const FieldExposure> dark,
                                                         std::span<const FieldExposure> flat,
                                                         const LightScale& light);

/// Appends them. Of levels that are given one at a time, as images of a camera, drops those that
/// clip: as above, in the order of exposures.
void leave_out_clipped(std::vector<ResponseLevel>& levels);

}  // namespace stipple
