#include "decoder/pixel_response.h"

#include <algorithm>
#include <cmath>

namespace stipple {
namespace {

constexpr double kSaturationSigmas = 5;

/// The calibration as if all pixels were this one.
Calibration calibration_of(Calibration whole, const CalibrationPixel& pixel) {
    whole.gain_e_per_dn /= pixel.conversion_gain;
    whole.electrons_per_unit *= pixel.responsivity;
    return whole;
}

/// The least DN that the full well or full scale may have clipped.
double saturation_dn(const Calibration& c) {
    const double full_scale_dn =
        static_cast<double>((1U << static_cast<unsigned>(c.bit_depth)) - 1);
    const double well_dn = c.full_well_e / c.gain_e_per_dn;
    const double read_dn = c.read_noise_e / c.gain_e_per_dn;
    const double noise_dn = std::sqrt(read_dn * read_dn + 1.0 / 12);
    // Where noise is as large as the well nothing is known, but half of it is no clipped sample.
    const double clipped_dn = std::max(well_dn - kSaturationSigmas * noise_dn, well_dn / 2);
    return std::min(full_scale_dn, c.black_level_dn + clipped_dn);
}

}  // namespace

SampleNoise::SampleNoise(const Calibration& calibration)
    : per_unit_(static_cast<float>(1 / calibration.electrons_per_unit)),
      one_dn_(static_cast<float>(calibration.gain_e_per_dn / calibration.electrons_per_unit)) {
    const double read = calibration.read_noise_e / calibration.electrons_per_unit;
    const double quantum = calibration.gain_e_per_dn / calibration.electrons_per_unit;
    constant_ = static_cast<float>(read * read + quantum * quantum / 12);
}

PixelResponse::PixelResponse(const Calibration& whole, const CalibrationPixel& pixel)
    : noise_(calibration_of(whole, pixel)) {
    const Calibration c = calibration_of(whole, pixel);
    black_level_dn_ = c.black_level_dn - (c.rounding == Rounding::kFloor ? 0.5 : 0.0);
    unit_per_dn_ = c.gain_e_per_dn / c.electrons_per_unit;
    dark_per_slot_ = c.dark_e_per_slot / c.electrons_per_unit;
    saturation_dn_ = saturation_dn(c);
    dark_variance_per_slot_ = static_cast<float>(dark_per_slot_ / c.electrons_per_unit);
}

PixelResponses::PixelResponses(const Calibration& calibration) {
    const CalibrationTile& tile = calibration.tile;
    if (tile.pixels.empty()) {
        responses_.emplace_back(calibration, CalibrationPixel{});
        return;
    }
    rows_ = tile.rows;
    cols_ = tile.cols;
    for (const CalibrationPixel& pixel : tile.pixels) responses_.emplace_back(calibration, pixel);
}

}  // namespace stipple
