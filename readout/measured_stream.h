#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/colour_filter.h"
#include "io/npy_file.h"
#include "stream/stream_header.h"

namespace stipple {

/// Arrays of a coded-aperture or micromirror camera, and what the arrays do not say.
struct MeasuredArrays {
    NpyVolume measurements;  ///< (measurement, row, col): each a sum of weight x light of its slots
    NpyVolume masks;         ///< (slot, row, col): weights x `white`, the same in each measurement
    std::string measurement_file;  ///< for messages and the provenance
    std::string mask_file;
    double white = 0;  ///< value of the masks that is weight 1; 0: `white_of`
    double light = 0;  ///< measurement of light 1.0 in one slot of weight 1; 0: `light_of`
    std::optional<double> saturation = {};  ///< measurements from here on are lower bounds
    std::optional<double> electrons = {};   ///< of light 1.0; without: there is no noise
    double read_noise_e = 0;                ///< standard deviation, in electrons
    ColourFilter cfa = ColourFilter::kNone;
    double slot_us = 5000;
};

/// What an import has made.
struct ImportedStream {
    StreamHeader header;
    int measurements = 0;
    double light = 0;               ///< measurement of light 1.0
    std::size_t unread_pixels = 0;  ///< whose masks are 0 in all slots: their measurements are lost
};

/// The measurement of light 1.0 if nobody says it: 255 if a measurement exceeds the sum of the
/// weights of its pixel, so that its light would be above 1.0, else 1.
[[nodiscard]] double light_of(const NpyVolume& measurements, const ExposureSchedule& schedule);

/// Writes the measurements as a stream whose period is that of the masks: a pixel's measurement m
/// is its sample at the end of its last open slot in period m. They are rounded to 65533 steps from
/// the least (or 0) to the greatest, and never DN 0 or full scale, so that none counts as clipped.
/// Light without noise has 10^6 electrons. \throws InputError if the sizes of the arrays differ, if
/// a measurement that is read is not finite or the masks are none (mask_schedule), or if no
/// measurement is above 0; DeviceError if `file` cannot be written.
ImportedStream import_measurements(const MeasuredArrays& arrays, const std::filesystem::path& file,
                                   bool force);

}  // namespace stipple
