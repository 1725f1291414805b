#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/colour_filter.h"
#include "stream/stream_header.h"
#include "stream/stream_reader.h"

namespace stipple {

// Figures of a stream under the names and in the units of docs/outputs.md (`info`). The functions
// `visit_...` call `add(name, value)` for each; values are numbers, texts, true or false, or lists
// of numbers.

/// Rows and columns of the schedule's tile; of a random schedule those of the array, whatever the
/// reader has kept of it.
struct TileShape {
    int rows = 0;
    int cols = 0;
};
[[nodiscard]] TileShape tile_shape_of(const StreamHeader& header);

/// True without damage, missing slots and incomplete tail. The end marker may be missing.
[[nodiscard]] bool undamaged(const StreamReport& report);

/// Damage of a stream in lines of text: the places of at most ten. Empty if it is undamaged.
[[nodiscard]] std::string damage_text(const StreamReport& report);

/// Of a decoded stream that is damaged: `damage_text`, then `hint`, then that the output contains
/// the undamaged part. Empty if it is undamaged.
[[nodiscard]] std::string decoded_damage_text(const StreamReport& report,
                                              std::string_view hint = {});
/// Of a decoded stream without a sample; else empty.
[[nodiscard]] std::string no_sample_text(const StreamReport& report);
/// Of an undamaged stream that was read up to its end, and has no end marker; else empty.
[[nodiscard]] std::string no_end_text(const StreamReport& report);

template <typename Add>
void visit_header_figures(const StreamHeader& header, const Add& add) {
    add("rows", header.shape.rows);
    add("cols", header.shape.cols);
    add("planes", header.shape.planes);
    add("cfa", name_of(header.cfa));
    add("slot_us", header.slot_us);
}

/// The key `calibration`.
template <typename Add>
void visit_calibration_figures(const Calibration& calibration, const Add& add) {
    std::vector<double> responsivity, conversion_gain;
    for (const CalibrationPixel& pixel : calibration.tile.pixels) {
        responsivity.push_back(pixel.responsivity);
        conversion_gain.push_back(pixel.conversion_gain);
    }
    add("bit_depth", calibration.bit_depth);
    add("rounding", name_of(calibration.rounding));
    add("black_level_dn", calibration.black_level_dn);
    add("gain_e_per_dn", calibration.gain_e_per_dn);
    add("read_noise_e", calibration.read_noise_e);
    add("full_well_e", calibration.full_well_e);
    add("electrons_per_unit", calibration.electrons_per_unit);
    add("dark_e_per_slot", calibration.dark_e_per_slot);
    add("noise_free", calibration.noise_free);
    add("tile_rows", calibration.tile.rows);
    add("tile_cols", calibration.tile.cols);
    add("responsivity", responsivity);
    add("conversion_gain", conversion_gain);
}

/// The key `schedule`.
template <typename Add>
void visit_schedule_figures(const StreamHeader& header, const Add& add) {
    const ExposureSchedule& schedule = header.schedule;
    const TileShape tile = tile_shape_of(header);
    add("name", header.schedule_name);
    add("tile_rows", tile.rows);
    add("tile_cols", tile.cols);
    add("period_slots", schedule.period_slots());
    add("samples_per_pixel_slot", schedule.samples_per_pixel_slot());
    add("light_throughput", schedule.light_throughput());
    add("gapless", schedule.gapless());
    add("interleaved", schedule.interleaved());
    add("weighted", schedule.weighted());
    if (header.schedule_source.kind == ScheduleSource::Kind::kRandom) {
        add("exposure_slots", header.schedule_source.exposure_slots);
        add("seed", header.schedule_source.seed);
    }
}

/// An entry of the list `switches`.
template <typename Add>
void visit_switch_figures(const ScheduleSwitch& part, const Add& add) {
    add("number", part.number);
    add("slot", part.slot);
    add("schedule", part.name);
    add("period_slots", part.schedule.period_slots());
    add("samples_per_pixel_slot", part.schedule.samples_per_pixel_slot());
    add("rounding", name_of(part.values.rounding));
    add("black_level_dn", part.values.black_level_dn);
    add("gain_e_per_dn", part.values.gain_e_per_dn);
    add("read_noise_e", part.values.read_noise_e);
    add("full_well_e", part.values.full_well_e);
    add("electrons_per_unit", part.values.electrons_per_unit);
}

/// Counts of the slots and packets that were read.
template <typename Add>
void visit_report_figures(const StreamReport& report, const Add& add) {
    add("slots", report.slots);
    add("packets", report.packets);
    add("samples", report.samples);
    add("payload_bits", report.payload_bits);
    add("missing_slots", report.missing_slots);
    add("complete", report.complete);
    add("tail_bytes", report.tail_bytes);
}

/// An entry of the list `damage`.
template <typename Add>
void visit_damage_figures(const StreamDamage& damage, const Add& add) {
    add("offset", damage.offset);
    add("bytes", damage.bytes);
    add("cause", damage.cause);
}

}  // namespace stipple
