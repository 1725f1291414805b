#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "calibration/field_samples.h"
#include "decoder/response_curve.h"
#include "stream/stream_header.h"

namespace stipple {

/// The groups of sites that see the same light: the planes, or the colours of a mosaic.
inline constexpr std::size_t kMaxLightGroups = 4;

[[nodiscard]] std::size_t light_group(const StreamHeader& header, std::size_t site);

/// The samples of one exposure time, with their noise; in linear DN, if there is a curve.
struct FieldExposure {
    double seconds = 0;
    const ExposureSums* sums = nullptr;
    const ResponseCurve* curve = nullptr;  ///< null: the chip is linear
    /// Temporal variance of a sample, mean over the sites of a group, in DN^2; at least 1 / 12,
    /// because the rounding errors of a sample without noise are the same in all frames.
    std::array<double, kMaxLightGroups> noise_dn2{};
    std::vector<double> row_error_dn2 = {};  ///< by plane, ExposureSums::row_error

    [[nodiscard]] bool has(std::size_t site) const { return sums->count[site] > 0; }
    /// Mean sample of a site. Precondition: has(site).
    [[nodiscard]] double mean(std::size_t site) const;
    /// Temporal variance of the samples of a site. Precondition: it has two.
    [[nodiscard]] double variance(std::size_t site) const;
    /// Variance of the mean of a site's samples: noise / number of samples. A site with more than
    /// four times the noise of its group has its own. Precondition: has(site).
    [[nodiscard]] double mean_variance(std::size_t site, std::size_t group) const;
    /// The same of a site with the noise of its group and the mean number of samples.
    [[nodiscard]] double usual_variance(std::size_t group) const {
        return noise_dn2[group] * static_cast<double>(sums->count.size()) /
               static_cast<double>(sums->samples);
    }
};

/// `sums` must outlive the result.
[[nodiscard]] FieldExposure field_exposure(std::int64_t exposure_ns, const ExposureSums& sums,
                                           const StreamHeader& header);

/// The same exposure in the linear DN of `curve`, which must outlive the result; null: in DN.
[[nodiscard]] FieldExposure linearised(FieldExposure exposure, const StreamHeader& header,
                                       const ResponseCurve* curve);

}  // namespace stipple
