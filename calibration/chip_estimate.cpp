#include "calibration/chip_estimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "calibration/chip_exposures.h"
#include "calibration/dark_maps.h"
#include "calibration/field_samples.h"
#include "core/error.h"
#include "core/index.h"
#include "decoder/pixel_response.h"
#include "decoder/response_curve.h"

namespace stipple {
namespace {

constexpr double kMinGain = 0.1;  ///< of a pixel that is no defect
constexpr double kMaxGain = 10;

/// Gain of a pixel by the tile of unequal pixels.
double nominal_gain(const StreamHeader& header, std::size_t pixel) {
    const CalibrationPixel nominal = nominal_pixel(header, pixel);
    return nominal.responsivity * nominal.conversion_gain;
}

/// The errors that the light of a row shares, with a gain of 1 by the tile.
double shared_by_rows(const StreamHeader& header, const std::vector<FieldExposure>& flat,
                      std::size_t first_site, const EstimateMap& offset,
                      const EstimateMap& dark_current) {
    const std::size_t group = light_group(header, first_site);
    double weights = 0, times = 0, noise = 0;
    for (const FieldExposure& e : flat) {
        const double t = e.seconds;
        const double own = e.usual_variance(group);
        weights += t * t / own;
        times += t / own;
        noise += t * t / (own * own) * e.row_error_dn2[first_site / header.shape.pixels()];
    }
    return (noise + times * times * offset.row_error) / (weights * weights) +
           dark_current.row_error;
}

/// Light per second of each pixel of a plane in DN, by weighted least squares over the exposure
/// times t of (y - b - d t) = light t. The errors of b and d are the same at all times.
EstimateMap lights(const StreamHeader& header, const std::vector<FieldExposure>& flat,
                   std::size_t first_site, const EstimateMap& offset,
                   const EstimateMap& dark_current) {
    EstimateMap map = offset;
    for (std::size_t i = 0; i < map.value.size(); ++i) {
        const std::size_t site = first_site + i;
        double sum = 0, weights = 0, times = 0, noise = 0;
        for (const FieldExposure& e : flat) {
            if (!e.has(site)) continue;
            const double t = e.seconds;
            const double own = e.mean_variance(site, light_group(header, site));
            const double variance = own + offset.variance[i] + t * t * dark_current.variance[i];
            sum += t / variance * (e.mean(site) - offset.value[i] - dark_current.value[i] * t);
            weights += t * t / variance;
            times += t / variance;
            noise += t * t / (variance * variance) * own;
        }
        const double nominal = nominal_gain(header, i);
        if (weights == 0) {
            map.value[i] = 0;
            map.variance[i] = std::numeric_limits<double>::infinity();
            continue;
        }
        map.value[i] = sum / weights / nominal;
        map.variance[i] = ((noise + times * times * offset.variance[i]) / (weights * weights) +
                           dark_current.variance[i]) /
                          (nominal * nominal);
    }
    map.row_error = shared_by_rows(header, flat, first_site, offset, dark_current);
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
                         fmt::format("is not brighter than its noise; {}", kTakeHalf));
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
        if (pixels.front() == 0) light.row_error /= mean * mean;  // as one colour for all
    }
}

/// Gains of a plane: the mean of those of all series, weighted by their variances.
EstimateMap gains_of(const CalibrationSeries& series, const ChipExposures& exposures,
                     std::size_t first_site, const EstimateMap& offset,
                     const EstimateMap& dark_current) {
    std::optional<EstimateMap> gain;
    for (const std::vector<FieldExposure>& flat : exposures.flats) {
        if (flat.empty()) continue;
        EstimateMap one = lights(series.header, flat, first_site, offset, dark_current);
        normalise(series, first_site, one);
        if (!gain) {
            gain = std::move(one);
            continue;
        }
        for (std::size_t i = 0; i < one.value.size(); ++i) {
            const double weight = 1 / gain->variance[i], more = 1 / one.variance[i];
            if (weight + more == 0) continue;  // no sample yet
            gain->value[i] = (weight * gain->value[i] + more * one.value[i]) / (weight + more);
            gain->variance[i] = 1 / (weight + more);
        }
        gain->row_error = std::max(gain->row_error, one.row_error);  // of the mean it is less
    }
    return *gain;
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
            .flats = static_cast<std::uint32_t>(fewest_samples(series.flats)),
            .darks = static_cast<std::uint32_t>(series.dark.fewest()),
            .sites = std::vector<SiteCalibration>(header.shape.sites()),
            .response = {}};
}

/// Of a series without dark current.
EstimateMap no_dark_currents(FrameShape shape) {
    return {.rows = shape.rows,
            .cols = shape.cols,
            .value = std::vector<double>(shape.pixels()),
            .variance = std::vector<double>(shape.pixels())};
}

/// Estimates one plane.
void estimate_plane(const CalibrationSeries& series, const ChipExposures& exposures, int plane,
                    ChipEstimate& result) {
    const StreamHeader& header = series.header;
    const FrameShape shape = header.shape;
    const std::size_t first = index(plane) * shape.pixels();
    const DarkMaps maps(header, exposures.dark, plane);
    EstimateMap current = series.dark_current ? maps.dark_currents() : no_dark_currents(shape);
    add(shrink(current), shape.planes, result.dark_dn_per_s);
    EstimateMap offset = maps.offsets(current);
    add(shrink(offset), shape.planes, result.offset_dn);
    EstimateMap noise = maps.readout_noise();
    add(shrink(noise), shape.planes, result.readout_noise_dn2);
    EstimateMap gain = gains_of(series, exposures, first, offset, current);
    const std::vector<double> measured_gain = gain.value;
    add(shrink(gain), shape.planes, result.gain);
    const SiteResponses responses(header);
    for (std::size_t i = 0; i < shape.pixels(); ++i) {
        const auto cols = index(shape.cols);
        const PixelResponse response =
            responses.at(plane, static_cast<int>(i / cols), static_cast<int>(i % cols));
        const bool dead = !(measured_gain[i] >= kMinGain && measured_gain[i] <= kMaxGain);
        SiteCalibration& site = result.calibration.sites[first + i];
        if (dead || saturated_in_the_dark(response, exposures.dark, first + i)) {
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
    ChipExposures exposures = chip_exposures(series);
    ChipEstimate result{.calibration = head_of(series),
                        .response = chip_response(series, exposures)};
    std::optional<ResponseCurve> curve;
    if (!result.response.table.linear_dn.empty()) {
        curve.emplace(result.response.table);
        const auto linearise = [&](FieldExposure& exposure) {
            exposure = linearised(exposure, series.header, &*curve);
        };
        std::ranges::for_each(exposures.dark, linearise);
        for (auto& flat : exposures.flats) std::ranges::for_each(flat, linearise);
    }
    for (int plane = 0; plane < series.header.shape.planes; ++plane)
        estimate_plane(series, exposures, plane, result);
    result.calibration.response = result.response.table;
    return result;
}

}  // namespace stipple
