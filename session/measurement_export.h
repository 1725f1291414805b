#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/named_value.h"
#include "core/progress.h"
#include "io/footage_part.h"
#include "io/named_arrays.h"
#include "io/output_names.h"
#include "io/pending_output.h"
#include "stream/stream_reader.h"

namespace stipple {

/// The masks of exported measurements.
enum class ExportMasks : std::uint8_t {
    kShared,  ///< (slots, rows, columns), those of each measurement: its slots follow each other
    kOwn,     ///< (measurements, slots, rows, columns): all measurements are of the same slots
};
inline constexpr auto kExportMasks = std::to_array<NamedValue<ExportMasks>>(
    {{"shared", ExportMasks::kShared}, {"own", ExportMasks::kOwn}});

struct ExportOptions {
    ExportMasks masks = ExportMasks::kShared;
    FrameRange slots = {};
};

/// The samples of a stream as other programs for snapshot compressive imaging take them
/// (docs/outputs.md), with light 1.0 in a slot of weight 1 as the unit:
///
///     meas[m, row, col] = sum over slots t of mask[t, row, col] light[m B + t, row, col]
///
/// of shared masks for B slots, and of own masks
///
///     meas[k, row, col] = sum over slots t of mask[k, t, row, col] light[t, row, col]
///
/// for the exposures k of a pixel that lie within the slots, by their first slot. Where a pixel has
/// fewer, meas and masks are 0.
struct MeasurementExport {
    std::vector<NamedArray> arrays;  ///< mask, meas, variance, saturated, zero, then numbers
    int rows = 0;
    int cols = 0;
    int measurements = 0;
    int slots = 0;                ///< of the masks
    std::int64_t first_slot = 0;  ///< in the stream
    bool weighted = false;
    std::uint64_t samples = 0;
    std::uint64_t saturated = 0;  ///< of these, lower bounds
    std::uint64_t zeros = 0;      ///< of these, at DN 0
};

/// Calls add(name, value) for each figure (docs/outputs.md).
template <typename Add>
void visit_export_figures(const MeasurementExport& result, const Add& add) {
    add("rows", result.rows);
    add("cols", result.cols);
    add("measurements", result.measurements);
    add("slots", result.slots);
    add("first_slot", result.first_slot);
    add("weighted", result.weighted);
    add("samples", result.samples);
    add("saturated", result.saturated);
    add("zeros", result.zeros);
}

/// Reads the slots of a stream at its beginning, whose sites may be calibrated. The progress is in
/// slots; nothing if it stops. \throws InputError if the stream has several planes or fewer slots;
/// for shared masks, if a pixel has several exposures in a period, one that goes on in the next, or
/// no sample of one; at a switch of the schedule; as StreamReader and check_memory.
[[nodiscard]] std::optional<MeasurementExport> export_measurements(
    StreamReader& stream, const ExportOptions& options, const ProgressCallback& progress);

inline constexpr OutputName kArraysName{
    "exported measurements are a .npz or a .mat", {".npz", ".mat"}, false};

/// Writes the arrays as the extension of the file says, and commits it. \throws InputError as
/// write_npz and write_mat; DeviceError.
void write_export(const MeasurementExport& result, PendingOutput& output);

}  // namespace stipple
