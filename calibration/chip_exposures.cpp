#include "calibration/chip_exposures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "core/error.h"
#include "core/index.h"
#include "decoder/pixel_response.h"
#include "decoder/response_curve.h"

namespace stipple {
namespace {

constexpr double kMaxZeros = 0.00135;   ///< of dark samples: three standard deviations of noise
constexpr double kMaxSaturated = 0.01;  ///< of flat samples: more are no defects

std::size_t times_of(const std::vector<FieldExposure>& exposures, std::size_t site) {
    return static_cast<std::size_t>(
        std::ranges::count_if(exposures, [site](const FieldExposure& e) { return e.has(site); }));
}

/// The exposures of the dark series. \throws InputError as estimate_chip.
std::vector<FieldExposure> dark_exposures(const CalibrationSeries& series) {
    require_samples({&series.dark, 1}, series.dark_name);
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
                                         "of another time, or give ",
                                         1e3 * dark.front().seconds) +
                                 Parameter{"no_dark_current", "true"});
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

/// \throws InputError unless every site has an exposure.
void require_exposures(const CalibrationSeries& series,
                       const std::vector<std::vector<FieldExposure>>& flats) {
    for (std::size_t site = 0; site < series.header.shape.sites(); ++site)
        if (std::ranges::all_of(flats, [site](const std::vector<FieldExposure>& flat) {
                return times_of(flat, site) == 0;
            }))
            fail_saturated(series, "some pixels have no exposure that is short enough");
}

/// The exposures of the flat series that do not saturate. \throws InputError as estimate_chip.
std::vector<std::vector<FieldExposure>> flat_exposures(const CalibrationSeries& series,
                                                       const FieldExposure& dark) {
    require_samples(series.flats, series.flat_name);
    std::vector<std::vector<FieldExposure>> flats;
    double min_saturated = 1;
    for (const FieldSamples& field : series.flats) {
        flats.emplace_back();
        for (const auto& [time, sums] : field.exposures()) {
            const double saturated =
                static_cast<double>(sums.saturated) / static_cast<double>(sums.samples);
            min_saturated = std::min(min_saturated, saturated);
            if (saturated > kMaxSaturated) continue;
            flats.back().push_back(field_exposure(time, sums, series.header));
            if (!series.well_known) require_shot_noise(series, dark, flats.back().back());
        }
    }
    if (std::ranges::all_of(flats, &std::vector<FieldExposure>::empty))
        fail_saturated(series, fmt::format("{:.2g} % of the samples are at full scale or full well",
                                           100 * min_saturated));
    require_exposures(series, flats);
    return flats;
}

/// Nothing is known of pixels of unequal conversion gain: one charge gives them several DN.
ResponseFit fit_levels(const CalibrationSeries& series, const ChipExposures& exposures) {
    const StreamHeader& header = series.header;
    if (std::ranges::any_of(header.calibration.tile.pixels, [](const CalibrationPixel& pixel) {
            return pixel.conversion_gain != 1;
        }))
        return {};
    std::vector<ResponseLevel> levels(series.levels.begin(), series.levels.end());
    for (std::size_t number = 0; series.levels.empty() && number < exposures.flats.size();
         ++number) {
        const auto more =
            response_levels(header, exposures.dark, exposures.flats[number], {.number = number});
        levels.insert(levels.end(), more.begin(), more.end());
    }
    if (levels.empty()) return {};
    const double black_dn = std::ranges::min_element(levels, {}, &ResponseLevel::dark_dn)->dark_dn;
    return fit_response(levels, {.black_dn = black_dn, .bit_depth = header.calibration.bit_depth},
                        series.flat_name);
}

/// Share of the sites whose mean sample saturates, by a response curve.
double saturated_sites(const StreamHeader& header, const FieldExposure& exposure,
                       const ResponseCurve& curve) {
    const Calibration& c = header.calibration;
    const double read_dn = c.read_noise_e / c.gain_e_per_dn;
    const SiteCalibration equal{.offset_dn = static_cast<float>(c.black_level_dn),
                                .readout_noise_dn2 = static_cast<float>(read_dn * read_dn)};
    double sites = 0, saturated = 0;
    for (std::size_t site = 0; site < header.shape.sites(); ++site) {
        if (!exposure.has(site)) continue;
        const PixelResponse response(c, nominal_pixel(header, site % header.shape.pixels()), equal,
                                     header.slot_us * 1e-6, &curve);
        ++sites;
        if (response.saturated(static_cast<std::uint16_t>(std::lround(exposure.sums->mean(site)))))
            ++saturated;
    }
    return saturated / std::max(sites, 1.0);
}

}  // namespace

std::uint64_t fewest_samples(std::span<const FieldSamples> fields) {
    std::uint64_t fewest = UINT64_MAX;
    for (std::size_t site = 0; site < fields.front().shape().sites(); ++site) {
        std::uint64_t count = 0;
        for (const FieldSamples& field : fields) count += field.count(site);
        fewest = std::min(fewest, count);
    }
    return fewest;
}

void require_samples(std::span<const FieldSamples> fields, std::string_view name) {
    const std::uint64_t fewest = fewest_samples(fields);
    if (fewest < kMinFieldSamples)
        throw InputError(name, fmt::format("has too few frames: {} samples of a pixel, and a "
                                           "calibration needs at least {}",
                                           fewest, kMinFieldSamples));
}

CalibrationPixel nominal_pixel(const StreamHeader& header, std::size_t pixel) {
    const CalibrationTile& tile = header.calibration.tile;
    if (tile.pixels.empty()) return {};
    const auto cols = index(header.shape.cols);
    return tile.pixels[pixel / cols % index(tile.rows) * index(tile.cols) +
                       pixel % cols % index(tile.cols)];
}

ChipExposures chip_exposures(const CalibrationSeries& series) {
    ChipExposures exposures{.dark = dark_exposures(series), .flats = {}};
    exposures.flats = flat_exposures(series, exposures.dark.front());
    return exposures;
}

ResponseFit chip_response(const CalibrationSeries& series, ChipExposures& exposures) {
    ResponseFit fit = fit_levels(series, exposures);
    if (fit.table.linear_dn.empty()) return fit;
    const ResponseCurve curve(fit.table);
    std::size_t left_out = 0;
    for (std::vector<FieldExposure>& flat : exposures.flats)
        left_out += std::erase_if(flat, [&](const FieldExposure& exposure) {
            return saturated_sites(series.header, exposure, curve) > kMaxSaturated;
        });
    if (left_out == 0) return fit;
    require_exposures(series, exposures.flats);
    return fit_levels(series, exposures);
}

}  // namespace stipple
