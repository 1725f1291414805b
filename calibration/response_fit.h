#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "calibration/field_samples.h"
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

/// The array of DN that a response is of.
struct DnRange {
    double black_dn = 0;  ///< mean sample without light
    int bit_depth = 8;
};

/// What levels of light tell of the response of a chip.
struct ResponseFit {
    ResponseTable table = {};  ///< empty: linear, as far as the levels tell
    std::size_t levels = 0;    ///< that count; 0: too few, so nothing is known
    double brightest_dn = 0;   ///< of these; the table goes on straight above it
    double bend_dn = 0;        ///< linear DN minus DN there
    double error_dn = 0;       ///< standard deviation of the linear DN there
};

/// Fits the linear DN f of a chip to levels of light whose ratios are known:
///
///     f(y) = y + (y - b) sum_j a_j u^j,  u = (y - b) / (2^d - 1 - b),  j = 1 .. J
///     f(mean) - f(dark) = c exposure,    c of each scale
///
/// by weighted least squares in a_j and c. So f has slope 1 in the dark and needs no absolute
/// light. J is 0 to 6: the one that minimises chi^2 / s + 2 J (Mallows 1973), s = max(1, chi^2 /
/// degrees of freedom of the largest J); 0 unless that lowers chi^2 / s by 16 J. The variances are
/// those of the fit times the same ratio at J. Scales of one level tell nothing. Nothing is known
/// with fewer than three levels in a scale. \throws InputError at `where` if the samples of a scale
/// fall while its exposures rise.
[[nodiscard]] ResponseFit fit_response(std::span<const ResponseLevel> levels, const DnRange& range,
                                       std::string_view where);

}  // namespace stipple
