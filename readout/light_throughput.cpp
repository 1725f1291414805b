#include "readout/light_throughput.h"

#include "core/exposure_schedule.h"

namespace stipple {
namespace {

/// From it on, slots of the same phase are alike.
std::int64_t first_steady_slot(const ExposureSchedule& schedule) {
    return std::max(schedule.longest_span_slots(), 1) - 1;
}

double transmittance(const CalibrationTile& tile, int row, int col) {
    if (tile.pixels.empty()) return 1;
    return tile
        .pixels[static_cast<std::size_t>(row % tile.rows) * static_cast<std::size_t>(tile.cols) +
                static_cast<std::size_t>(col % tile.cols)]
        .responsivity;
}

/// Slots of light that a due pixel has collected.
double light_slots(const ExposureSchedule& schedule, std::int64_t slot, int row, int col,
                   const DuePixel& pixel) {
    if (!schedule.weighted()) return pixel.light_slots;
    const std::int64_t begin = slot - pixel.span_slots + 1;
    const int tile_row = row % schedule.tile_rows();
    const int tile_col = col % schedule.tile_cols();
    const std::size_t i = exposure_starting_at(schedule, tile_row, tile_col, begin);
    return schedule.light_slots(tile_row, tile_col, schedule.exposures(tile_row, tile_col)[i]);
}

}  // namespace

double light_throughput(const ExposureSchedule& schedule, const CalibrationTile& tile,
                        FrameShape shape) {
    if (tile.pixels.empty()) return schedule.light_throughput();
    double light = 0;
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col) {
            const int tile_row = row % schedule.tile_rows();
            const int tile_col = col % schedule.tile_cols();
            double collected = 0;
            for (const Exposure& exposure : schedule.exposures(tile_row, tile_col))
                collected += schedule.light_slots(tile_row, tile_col, exposure);
            light += collected * transmittance(tile, row, col);
        }
    return light / (schedule.period_slots() * static_cast<double>(shape.pixels()));
}

double light_due(const ExposureSchedule& schedule, const CalibrationTile& tile,
                 const SlotRows& rows) {
    double light = 0;
    for (int row = rows.first_row; row < rows.end_row; ++row)
        visit_due_pixels(schedule, rows.slot, row, rows.cols, [&](int col, const DuePixel& pixel) {
            light +=
                light_slots(schedule, rows.slot, row, col, pixel) * transmittance(tile, row, col);
        });
    return light;
}

std::int64_t kind_of_slot(const ExposureSchedule& schedule, std::int64_t slot) {
    const std::int64_t steady = first_steady_slot(schedule);
    return slot < steady ? slot : steady + (slot - steady) % schedule.period_slots();
}

double light_due_in_clip(const ExposureSchedule& schedule, const CalibrationTile& tile,
                         FrameShape shape, std::int64_t slots) {
    const std::int64_t period = schedule.period_slots();
    const std::int64_t steady = first_steady_slot(schedule);
    double light = 0;
    for (std::int64_t slot = 0; slot < std::min(slots, steady + period); ++slot) {
        const std::int64_t times = slot < steady ? 1 : 1 + (slots - 1 - slot) / period;
        light += static_cast<double>(times) *
                 light_due(schedule, tile, {slot, 0, shape.rows, shape.cols});
    }
    return light;
}

}  // namespace stipple
