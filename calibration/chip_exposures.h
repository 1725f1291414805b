#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "calibration/chip_estimate.h"
#include "calibration/field_samples.h"
#include "calibration/response_fit.h"
#include "stream/stream_header.h"

namespace stipple {

/// The exposures of the series of a chip that say something.
struct ChipExposures {
    std::vector<FieldExposure> dark;
    std::vector<std::vector<FieldExposure>> flats;  ///< of each series, without those that saturate
};

/// Remedy for flats that are too bright or too dim.
inline constexpr std::string_view kTakeHalf = "take it at about half of saturation";

/// Samples of the site that has the fewest, over all series.
[[nodiscard]] std::uint64_t fewest_samples(std::span<const FieldSamples> fields);

/// \throws InputError naming the series if a site has fewer than kMinFieldSamples.
void require_samples(std::span<const FieldSamples> fields, std::string_view name);

/// A pixel of the array by the tile of unequal pixels.
[[nodiscard]] CalibrationPixel nominal_pixel(const StreamHeader& header, std::size_t pixel);

/// \throws InputError as estimate_chip of series without samples, or that saturate.
[[nodiscard]] ChipExposures chip_exposures(const CalibrationSeries& series);

/// The response of the chip. Exposures that saturate by it are left out. Nothing is known of a chip
/// whose pixels have unequal conversion gains: one charge gives them several DN. \throws InputError
/// as fit_response, and if all exposures of a site saturate.
[[nodiscard]] ResponseFit chip_response(const CalibrationSeries& series, ChipExposures& exposures);

}  // namespace stipple
