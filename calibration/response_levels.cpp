#include "calibration/response_fit.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calibration/shrinkage.h"

namespace stipple {
namespace {

/// Sites of a light group that have samples at all exposures, without outliers.
std::vector<std::size_t> common_sites(const StreamHeader& header, std::size_t group,
                                      std::span<const FieldExposure> dark,
                                      std::span<const FieldExposure> flat) {
    std::vector<std::size_t> sites;
    const auto has = [&](const FieldExposure& exposure) {
        return [&](std::size_t site) { return exposure.has(site); };
    };
    for (std::size_t site = 0; site < header.shape.sites(); ++site) {
        if (light_group(header, site) != group) continue;
        if (std::ranges::all_of(dark, [&](const FieldExposure& e) { return has(e)(site); }) &&
            std::ranges::all_of(flat, [&](const FieldExposure& e) { return has(e)(site); }))
            sites.push_back(site);
    }
    const auto keep_inliers = [&](const FieldExposure& exposure) {
        EstimateMap means;
        for (const std::size_t site : sites) {
            means.value.push_back(exposure.mean(site));
            means.variance.push_back(0);
        }
        const std::vector<bool> used = inliers(means);
        std::size_t i = 0;
        std::erase_if(sites, [&](std::size_t) { return !used[i++]; });
    };
    std::ranges::for_each(dark, keep_inliers);
    std::ranges::for_each(flat, keep_inliers);
    return sites;
}

/// Mean over sites, with the variance of their temporal noise.
struct MeanSample {
    double dn = 0;
    double variance_dn2 = 0;
};

MeanSample mean_sample(const FieldExposure& exposure, std::size_t group,
                       const std::vector<std::size_t>& sites) {
    MeanSample sum;
    double squares = 0;
    for (const std::size_t site : sites) {
        const double dn = exposure.mean(site);
        sum.dn += dn;
        squares += dn * dn;
        sum.variance_dn2 += exposure.mean_variance(site, group);
    }
    const auto n = static_cast<double>(sites.size());
    MeanSample mean{.dn = sum.dn / n, .variance_dn2 = sum.variance_dn2 / (n * n)};
    // Where neither noise nor pattern spreads samples over half a DN, all are rounded alike.
    constexpr double kRoundedAlike = 0.25, kRoundingDn2 = 1.0 / 12;
    const double pattern_dn2 = squares / n - mean.dn * mean.dn;
    if (exposure.noise_dn2[group] + pattern_dn2 < kRoundedAlike) mean.variance_dn2 += kRoundingDn2;
    return mean;
}

/// Straight line through the dark means of a group, over exposure time.
struct DarkLine {
    double offset_dn = 0;
    double dn_per_s = 0;
};

DarkLine dark_line(std::span<const FieldExposure> dark, std::size_t group,
                   const std::vector<std::size_t>& sites) {
    double s = 0, st = 0, stt = 0, sy = 0, sty = 0;
    for (const FieldExposure& exposure : dark) {
        const MeanSample mean = mean_sample(exposure, group, sites);
        const double weight = 1 / mean.variance_dn2, t = exposure.seconds;
        s += weight;
        st += weight * t;
        stt += weight * t * t;
        sy += weight * mean.dn;
        sty += weight * t * mean.dn;
    }
    if (dark.size() < 2) return {.offset_dn = sy / s, .dn_per_s = 0};
    const double slope = (s * sty - st * sy) / (s * stt - st * st);
    return {.offset_dn = (sy - slope * st) / s, .dn_per_s = slope};
}

}  // namespace

void leave_out_clipped(std::vector<ResponseLevel>& levels) {
    constexpr double kClippedNoise = 0.7;  ///< of the level before
    constexpr double kClippedMean = 0.9;   ///< darker levels do not clip: their light is another
    std::ranges::sort(levels, {}, [](const ResponseLevel& level) {
        return std::pair(level.scale, level.exposure);
    });
    std::vector<ResponseLevel> kept;
    for (auto first = levels.begin(); first != levels.end();) {
        const auto end = std::find_if(first, levels.end(), [first](const ResponseLevel& level) {
            return level.scale != first->scale;
        });
        const auto clipped = std::adjacent_find(
            first, end, [](const ResponseLevel& before, const ResponseLevel& level) {
                return level.noise_dn2 < kClippedNoise * before.noise_dn2 &&
                       level.mean_dn - level.dark_dn >=
                           kClippedMean * (before.mean_dn - before.dark_dn);
            });
        std::copy(first, clipped, std::back_inserter(kept));
        first = end;
    }
    levels = std::move(kept);
}

std::vector<ResponseLevel> response_levels(const StreamHeader& header,
                                           std::span<const FieldExposure> dark,
                                           std::span<const FieldExposure> flat,
                                           const LightScale& light) {
    std::vector<ResponseLevel> levels;
    for (std::size_t group = 0; group < kMaxLightGroups; ++group) {
        const std::vector<std::size_t> sites = common_sites(header, group, dark, flat);
        if (sites.empty()) continue;
        const DarkLine line = dark_line(dark, group, sites);
        for (const FieldExposure& exposure : flat) {
            const MeanSample mean = mean_sample(exposure, group, sites);
            levels.push_back({.scale = light.number * kMaxLightGroups + group,
                              .exposure = light.light_per_s * exposure.seconds,
                              .dark_dn = line.offset_dn + line.dn_per_s * exposure.seconds,
                              .mean_dn = mean.dn,
                              .variance_dn2 = mean.variance_dn2,
                              .noise_dn2 = exposure.noise_dn2[group]});
        }
    }
    leave_out_clipped(levels);
    return levels;
}

}  // namespace stipple
