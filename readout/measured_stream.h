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

/// Where the arrays are: .npy, .npz or .mat files.
struct MeasuredFiles {
    std::string measurements;
    std::string masks;                   ///< empty: that of the measurements, a .npz or .mat
    std::string variable = "meas";       ///< in a .npz or .mat
    std::string mask_variable = "mask";  ///< likewise
    int slots = 0;                       ///< of a measurement: the first masks of the file; 0: all
};

/// The first masks only, if fewer than all belong to a measurement; 0: all. \throws InputError that
/// names `file` if it has fewer.
void keep_masks(NpyVolume& masks, int slots, const std::string& file);

/// Reads `arrays.measurements` and `arrays.masks`, and names their files. \throws InputError as the
/// readers of such files, without masks, and if there are fewer than `slots`.
void read_measured_files(const MeasuredFiles& files, MeasuredArrays& arrays);

/// What an import has made.
struct ImportedStream {
    StreamHeader header;
    int measurements = 0;
    double light = 0;               ///< measurement of light 1.0
    std::size_t unread_pixels = 0;  ///< whose masks are 0 in all slots: their measurements are lost
};

/// Calls add(name, value) for each figure (docs/outputs.md).
template <typename Add>
void visit_import_figures(const ImportedStream& stream, const Add& add) {
    const ExposureSchedule& schedule = stream.header.schedule;
    add("rows", stream.header.shape.rows);
    add("cols", stream.header.shape.cols);
    add("measurements", stream.measurements);
    add("slots", stream.measurements * schedule.period_slots());
    add("weighted", schedule.weighted());
    add("light_throughput", schedule.light_throughput());
    add("light", stream.light);
    add("unread_pixels", stream.unread_pixels);
    add("noise_free", stream.header.calibration.noise_free);
}

/// The warning that measurements are lost; empty if none are.
[[nodiscard]] std::string unread_text(const ImportedStream& stream, const std::string& mask_file);

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
