#include "readout/schedules/schedule_figures.h"

#include <algorithm>
#include <limits>

#include "readout/program/sequencer_program.h"

namespace stipple {
namespace {

void count_exposures(const ExposureSchedule& schedule, ScheduleFigures& figures) {
    figures.min_exposures = std::numeric_limits<int>::max();
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col) {
            const auto count = static_cast<int>(schedule.exposures(row, col).size());
            figures.min_exposures = std::min(figures.min_exposures, count);
            figures.max_exposures = std::max(figures.max_exposures, count);
        }
}

void count_due_pixels(const ExposureSchedule& schedule, FrameShape shape,
                      ScheduleFigures& figures) {
    const std::int64_t period = schedule.period_slots();
    const std::int64_t first = (kMaxExposureSlots + period - 1) / period * period;
    std::uint64_t total = 0;
    figures.min_due = std::numeric_limits<std::uint64_t>::max();
    for (std::int64_t slot = first; slot < first + period; ++slot) {
        const std::uint64_t due = count_due(schedule, slot, 0, shape.rows, shape.cols);
        figures.min_due = std::min(figures.min_due, due);
        figures.max_due = std::max(figures.max_due, due);
        total += due;
    }
    figures.mean_due = static_cast<double>(total) / static_cast<double>(period);
}

}  // namespace

ScheduleFigures schedule_figures(const ExposureSchedule& schedule, FrameShape shape) {
    ScheduleFigures figures;
    figures.tile_rows = schedule.tile_rows();
    figures.tile_cols = schedule.tile_cols();
    figures.period_slots = schedule.period_slots();
    figures.compression_ratio = 1 / schedule.samples_per_pixel_slot();
    figures.light_throughput = schedule.light_throughput();
    figures.charge_stores = schedule.charge_stores();
    figures.code_memory_bits = schedule_memory_bits(schedule);
    count_exposures(schedule, figures);
    count_due_pixels(schedule, shape, figures);
    return figures;
}

}  // namespace stipple
