#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "calibration/chip_calibration.h"
#include "calibration/field_samples.h"
#include "calibration/response_fit.h"
#include "calibration/shrinkage.h"
#include "stream/stream_header.h"

namespace stipple {

/// The series that a calibration is estimated from.
struct CalibrationSeries {
    const StreamHeader& header;  ///< of the chip: shape, colours, bits, tile of unequal pixels
    const FieldSamples& dark;
    std::span<const FieldSamples> flats;  ///< each of constant light
    /// That tell the response curve; empty: those of `flats`, by the exposure times of each.
    std::span<const ResponseLevel> levels = {};
    std::string dark_name = "dark series";  ///< in messages
    std::string flat_name = "flat series";
    bool well_known = true;    ///< false: `header` has no full well
    bool dark_current = true;  ///< false: it is 0, and one exposure time in the dark is enough
};

/// Min number of samples of a site in the dark, and in uniform light.
inline constexpr std::uint64_t kMinFieldSamples = 8;

/// A calibration, and what makes the sites differ: means over the planes.
struct ChipEstimate {
    ChipCalibration calibration;  ///< without identity of the chip
    PatternVariances gain = {};   ///< PRNU^2 and so on
    PatternVariances offset_dn = {};
    PatternVariances dark_dn_per_s = {};
    PatternVariances readout_noise_dn2 = {};
    ResponseFit response = {};  ///< its table is that of `calibration`
    std::size_t defects = 0;
};

/// Estimates the response curve of the chip, as fit_response, and then, in linear DN, the
/// calibration of each site (docs/calibration.md has the formulas): offset and dark current by
/// weighted least squares over the exposure times of the dark series, gain by flat-field
/// correction, relative to its mean over the sites of one colour; all shrunk by their measurement
/// variances. Sites are defects if their gain is below 0.1 or above 10 times the mean, or if they
/// are saturated in the dark.
/// \throws InputError naming the series: fewer than kMinFieldSamples samples of a site; only one
/// exposure time in the dark; more than 0.135 % of the dark samples are DN 0; more than 1 % of the
/// flat samples saturate at every exposure time; the flat series is no brighter than the dark one.
[[nodiscard]] ChipEstimate estimate_chip(const CalibrationSeries& series);

}  // namespace stipple
