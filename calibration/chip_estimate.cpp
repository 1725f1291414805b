#include "calibration/chip_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

#include "calibration/dark_maps.h"
#include "calibration/field_exposure.h"
#include "core/error.h"
#include "core/index.h"
#include "decoder/pixel_response.h"

namespace stipple {
namespace {

constexpr double kMaxZeros = 0.00135;   ///< of dark samples: three standard deviations of noise
constexpr double kMaxSaturated = 0.01;  ///< of flat samples: more are no defects
constexpr double kMinGain = 0.1;        ///< of a pixel that is no defect
constexpr double kMaxGain = 10;

constexpr std::string_view kTakeHalf = "take it at about half of saturation";

void require_samples(const FieldSamples& field, std::string_view name) {
    const std::uint64_t fewest = field.exposures().empty() ? 0 : field.fewest();
    if (fewest < kMinFieldSamples)
        throw InputError(name, fmt::format("has too few frames: {} samples of a pixel, and a "
                                           "calibration needs at least {}",
                                           fewest, kMinFieldSamples));
}

std::size_t times_of(const std::vector<FieldExposure>& exposures, std::size_t site) {
    return static_cast<std::size_t>(
        std::ranges::count_if(exposures, [site](const FieldExposure& e) { return e.has(site); }));
}

/// The exposures of the dark series. \throws InputError as estimate_chip.
std::vector<FieldExposure> dark_exposures(const CalibrationSeries& series) {
    require_samples(series.dark, series.dark_name);
    std::vector<FieldExposure> dark;
    double zeros = 0, samples = 0;
    for (const auto& [time, sums] : series.dark.exposures()) {
        dark.push_back(field_exposure(time, sums, series.header));
        zeros += static_cast<double>(sums.zeros);
        samples += static_cast<double>(sums.samples);
    }
    if (zeros > kMaxZeros * samples)
        throw InputError(
            series.dark_name,
            fmt::format("{:.2g} % of the samples are DN 0, so the noise is cut off and "
                        "offsets cannot be measured; raise the black level",
                        100 * zeros / samples));
    for (std::size_t site = 0; series.dark_current && site < series.header.shape.sites(); ++site)
        if (times_of(dark, site) < 2)
            throw InputError(series.dark_name,
                             fmt::format("shows pixels in the dark at one exposure time only ({:g} "
                                         "ms), which does not tell their dark current; add frames "
                                         "of another time, or give --no-dark-current",
                                         1e3 * dark.front().seconds));
    return dark;
}

[[noreturn]] void fail_saturated(const CalibrationSeries& series, std::string_view how) {
    throw InputError(series.flat_name, fmt::format("saturates: {}; {}", how, kTakeHalf));
}

/// \throws InputError if light adds no noise, as above a full well that the header does not tell.
void require_shot_noise(const CalibrationSeries& series, const FieldExposure& dark,
                        const FieldExposure& flat) {
    constexpr double kShotNoise = 1.1;    ///< least ratio of variances
    constexpr double kBrightSigmas = 20;  ///< of the dark noise, where shot noise shows
    double light = 0, sites = 0;
    for (std::size_t site = 0; site < series.header.shape.sites(); ++site) {
        if (!dark.has(site) || !flat.has(site)) continue;
        light += flat.sums->mean(site) - dark.sums->mean(site);
        ++sites;
    }
    if (light > kBrightSigmas * std::sqrt(dark.noise_dn2[0]) * sites &&
        flat.noise_dn2[0] < kShotNoise * dark.noise_dn2[0])
        fail_saturated(series, "its noise is that of the dark series");
}

/// The exposures of the flat series that do not saturate. \throws InputError as estimate_chip.
std::vector<FieldExposure> flat_exposures(const CalibrationSeries& series,
                                          const FieldExposure& dark) {
    require_samples(series.flat, series.flat_name);
    std::vector<FieldExposure> flat;
    double min_saturated = 1;
    for (const auto& [time, sums] : series.flat.exposures()) {
        const double saturated =
            static_cast<double>(sums.saturated) / static_cast<double>(sums.samples);
        min_saturated = std::min(min_saturated, saturated);
        if (saturated > kMaxSaturated) continue;
        flat.push_back(field_exposure(time, sums, series.header));
        if (!series.well_known) require_shot_noise(series, dark, flat.back());
    }
    if (flat.empty())
        fail_saturated(series, fmt::format("{:.2g} % of the samples are at full scale or full well",
                                           100 * min_saturated));
    for (std::size_t site = 0; site < series.header.shape.sites(); ++site)
        if (times_of(flat, site) == 0)
            fail_saturated(series, "some pixels have no exposure that is short enough");
    return flat;
}

/// Gain of a pixel by the tile of unequal pixels.
double nominal_gain(const StreamHeader& header, std::size_t pixel) {
    const CalibrationTile& tile = header.calibration.tile;
    if (tile.pixels.empty()) return 1;
    const auto cols = index(header.shape.cols);
    const CalibrationPixel& one = tile.pixels[pixel / cols % index(tile.rows) * index(tile.cols) +
                                              pixel % cols % index(tile.cols)];
    return one.responsivity * one.conversion_gain;
}

/// Light per second of each pixel of a plane in DN, by weighted least squares over the exposure
/// times t of (y - b - d t) = light t.
EstimateMap lights(const StreamHeader& header, const std::vector<FieldExposure>& flat,
                   std::size_t first_site, const EstimateMap& offset,
                   const EstimateMap& dark_current) {
    EstimateMap map = offset;
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        const std::size_t site = first_site + i;
        double sum = 0, weights = 0;
        for (const FieldExposure& e : flat) {
            if (!e.has(site)) continue;
            const double t = e.seconds;
            const double variance = e.mean_variance(site, light_group(header, site)) +
                                    offset.variance[i] + t * t * dark_current.variance[i];
            sum +=
                t / variance * (e.sums->mean(site) - offset.value[i] - dark_current.value[i] * t);
            weights += t * t / variance;
        }
        const double nominal = nominal_gain(header, i);
        map.value[i] = sum / weights / nominal;
        map.variance[i] = 1 / weights / (nominal * nominal);
    }
    return map;
}

/// Mean of these pixels without outliers. \throws InputError if it is no brighter than noise.
double mean_light(const CalibrationSeries& series, const EstimateMap& light,
                  const std::vector<std::size_t>& pixels) {
    constexpr double kDimSigmas = 3;
    EstimateMap ours;
    for (const std::size_t i : pixels) {
        ours.value.push_back(light.value[i]);
        ours.variance.push_back(light.variance[i]);
    }
    const std::vector<bool> used = inliers(ours);
    const double mean = mean_of(ours.value, used);
    if (!(mean > kDimSigmas * std::sqrt(mean_of(ours.variance, used))))
        throw InputError(series.flat_name,
                         fmt::format("is no brighter than its noise; {}", kTakeHalf));
    return mean;
}

/// Divides the light of each group of a plane by its mean: gains.
void normalise(const CalibrationSeries& series, std::size_t first_site, EstimateMap& light) {
    for (std::size_t group = 0; group < kMaxLightGroups; ++group) {
        std::vector<std::size_t> pixels;
        for (std::size_t i = 0; i < light.value.size(); ++i)
            if (light_group(series.header, first_site + i) == group) pixels.push_back(i);
        if (pixels.empty()) continue;
        const double mean = mean_light(series, light, pixels);
        for (const std::size_t i : pixels) {
            light.value[i] /= mean;
            light.variance[i] /= mean * mean;
        }
    }
}

bool saturated_in_the_dark(const PixelResponse& response, const std::vector<FieldExposure>& dark,
                           std::size_t site) {
    return std::ranges::any_of(dark, [&](const FieldExposure& e) {
        return e.has(site) &&
               response.saturated(static_cast<std::uint16_t>(std::lround(e.sums->mean(site))));
    });
}

/// Adds the share of one of `planes` planes to a mean over planes.
void add(const PatternVariances& plane, int planes, PatternVariances& mean) {
    mean.mean += plane.mean / planes;
    mean.rows += plane.rows / planes;
    mean.cols += plane.cols / planes;
    mean.pixels += plane.pixels / planes;
    mean.outliers += plane.outliers;
}

ChipCalibration head_of(const CalibrationSeries& series) {
    const StreamHeader& header = series.header;
    return {.shape = header.shape,
            .cfa = header.cfa,
            .bit_depth = header.calibration.bit_depth,
            .tile_rows = header.calibration.tile.rows,
            .tile_cols = header.calibration.tile.cols,
            .chip = {},
            .flats = static_cast<std::uint32_t>(series.flat.fewest()),
            .darks = static_cast<std::uint32_t>(series.dark.fewest()),
            .sites = std::vector<SiteCalibration>(header.shape.sites())};
}

/// Of a series without dark current.
EstimateMap no_dark_currents(FrameShape shape) {
    return {.rows = shape.rows,
            .cols = shape.cols,
            .value = std::vector<double>(shape.pixels()),
            .variance = std::vector<double>(shape.pixels())};
}

/// Estimates one plane.
void estimate_plane(const CalibrationSeries& series, const std::vector<FieldExposure>& dark,
                    const std::vector<FieldExposure>& flat, int plane, ChipEstimate& result) {
    const StreamHeader& header = series.header;
    const FrameShape shape = header.shape;
    const std::size_t first = index(plane) * shape.pixels();
    const DarkMaps maps(header, dark, plane);
    EstimateMap current = series.dark_current ? maps.dark_currents() : no_dark_currents(shape);
    add(shrink(current), shape.planes, result.dark_dn_per_s);
    EstimateMap offset = maps.offsets(current);
    add(shrink(offset), shape.planes, result.offset_dn);
    EstimateMap noise = maps.readout_noise();
    add(shrink(noise), shape.planes, result.readout_noise_dn2);
    EstimateMap gain = lights(header, flat, first, offset, current);
    normalise(series, first, gain);
    const std::vector<double> measured_gain = gain.value;
    add(shrink(gain), shape.planes, result.gain);
    const SiteResponses responses(header);
    for (std::size_t i = 0; i < shape.pixels(); ++i) {
        const auto cols = index(shape.cols);
        const PixelResponse response =
            responses.at(plane, static_cast<int>(i / cols), static_cast<int>(i % cols));
        const bool dead = !(measured_gain[i] >= kMinGain && measured_gain[i] <= kMaxGain);
        SiteCalibration& site = result.calibration.sites[first + i];
        if (dead || saturated_in_the_dark(response, dark, first + i)) {
            site = {.defect = true};
            ++result.defects;
            continue;
        }
        site = {.gain = static_cast<float>(gain.value[i]),
                .gain_variance = static_cast<float>(gain.variance[i]),
                .offset_dn = static_cast<float>(offset.value[i]),
                .offset_variance_dn2 = static_cast<float>(offset.variance[i]),
                .dark_dn_per_s = static_cast<float>(current.value[i]),
                .dark_variance = static_cast<float>(current.variance[i]),
                .readout_noise_dn2 = static_cast<float>(std::max(noise.value[i], 0.0)),
                .defect = false};
    }
}

}  // namespace

ChipEstimate estimate_chip(const CalibrationSeries& series) {
    const std::vector<FieldExposure> dark = dark_exposures(series);
    const std::vector<FieldExposure> flat = flat_exposures(series, dark.front());
    ChipEstimate result{.calibration = head_of(series)};
    for (int plane = 0; plane < series.header.shape.planes; ++plane)
        estimate_plane(series, dark, flat, plane, result);
    return result;
}

}  // namespace stipple
