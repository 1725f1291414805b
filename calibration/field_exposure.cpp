#include "calibration/field_exposure.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "calibration/shrinkage.h"
#include "core/colour_filter.h"
#include "core/index.h"

namespace stipple {

std::size_t light_group(const StreamHeader& header, std::size_t site) {
    if (header.cfa == ColourFilter::kNone) return site / header.shape.pixels();
    const auto cols = index(header.shape.cols);
    return index(
        colour_plane(header.cfa, static_cast<int>(site / cols), static_cast<int>(site % cols)));
}

double FieldExposure::mean(std::size_t site) const {
    const double dn = sums->mean(site);
    return curve == nullptr ? dn : curve->linear_mean(dn);
}

double FieldExposure::variance(std::size_t site) const {
    const double dn2 = sums->variance(site);
    if (curve == nullptr) return dn2;
    const auto slope = static_cast<double>(
        curve->slope(static_cast<std::uint16_t>(std::lround(sums->mean(site)))));
    return slope * slope * dn2;
}

double FieldExposure::mean_variance(std::size_t site, std::size_t group) const {
    constexpr double kNoisy = 4;
    const double pooled = noise_dn2[group];
    const double own = sums->count[site] > 1 ? variance(site) : 0;
    return (own > kNoisy * pooled ? own : pooled) / sums->count[site];
}

FieldExposure linearised(FieldExposure exposure, const StreamHeader& header,
                         const ResponseCurve* curve) {
    constexpr double kRoundingDn2 = 1.0 / 12;
    const ExposureSums& sums = *exposure.sums;
    exposure.curve = curve;
    for (std::size_t group = 0; group < kMaxLightGroups; ++group) {
        EstimateMap means;
        std::vector<double> variances;
        for (std::size_t site = 0; site < sums.count.size(); ++site) {
            if (light_group(header, site) != group || sums.count[site] < 2) continue;
            means.value.push_back(exposure.mean(site));
            means.variance.push_back(0);
            variances.push_back(exposure.variance(site));
        }
        exposure.noise_dn2[group] = std::max(mean_of(variances, inliers(means)), kRoundingDn2);
    }
    const double mean_dn =
        std::accumulate(sums.sum.begin(), sums.sum.end(), 0.0) / static_cast<double>(sums.samples);
    const auto slope = static_cast<double>(
        curve == nullptr ? 1 : curve->slope(static_cast<std::uint16_t>(std::lround(mean_dn))));
    exposure.row_error_dn2.clear();
    for (int plane = 0; plane < header.shape.planes; ++plane)
        exposure.row_error_dn2.push_back(slope * slope * sums.row_error(plane, header.shape));
    return exposure;
}

FieldExposure field_exposure(std::int64_t exposure_ns, const ExposureSums& sums,
                             const StreamHeader& header) {
    return linearised({.seconds = 1e-9 * static_cast<double>(exposure_ns), .sums = &sums}, header,
                      nullptr);
}

}  // namespace stipple
