#include "sensor_model/binning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace stipple {
namespace {

/// Terms of the pixels, in both modes.
void bin_pixels(PhysicalTerms& terms, double n) {
    const double area = n * n;
    terms.dark_current_e_per_s *= area;
    terms.dsnu_e *= n;
    terms.prnu /= n;
    terms.dual_gain_limit_e *= area;
    terms.hot_pixel_fraction = std::min(terms.hot_pixel_fraction * area, 0.5);
    terms.dead_pixel_fraction = 0;  // a dead pixel takes a part of the light only
    terms.crosstalk /= n;           // across the border of the sum
    terms.blooming /= n;
}

/// Noise of n x n readings.
void add_readings(SensorParams& params, double n) {
    PhysicalTerms& terms = params.physical;
    params.read_noise_e *= n;
    terms.low_gain_read_noise_e *= n;
    terms.reset_noise_e *= n;
    terms.read_noise_spread /= n;
    // n pixels of a row or column share their noise, which adds as it is; that of n rows or columns
    // in power.
    const double lines = n * std::sqrt(n);
    for (double& noise : terms.row_noise_e) noise *= lines;
    terms.column_noise_e *= lines;
    terms.column_temporal_noise_e *= lines;
}

}  // namespace

SensorParams binned(SensorParams params, int n, BinningMode mode) {
    const PhysicalTerms& terms = params.physical;
    if (n < 1 || n > kMaxBinning)
        throw InputError("binning", fmt::format("{} is not 1 to {} pixels", n, kMaxBinning));
    if (n == 1) return params;
    if (terms.cfa != ColourFilter::kNone || !terms.transmittance.empty() || !terms.gain_map.empty())
        throw InputError(fmt::format("sensor \"{}\": binning", params.name),
                         "adds equal pixels only; leave out cfa, transmittance and gain_map");
    const double area = static_cast<double>(n) * n;
    params.photons_per_unit *= area;
    params.full_scale_e *= area;
    params.full_well_e *= area;
    bin_pixels(params.physical, n);
    if (mode == BinningMode::kVoltage) add_readings(params, n);
    validate(params);
    return params;
}

}  // namespace stipple
