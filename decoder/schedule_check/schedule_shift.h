#pragma once

#include <algorithm>
#include <cstdint>

#include "core/exposure_schedule.h"

namespace stipple {

/// Shift of a schedule relative to its samples: pixel (row, col) in slot t follows the schedule of
/// pixel (row + rows, col + cols) in slot t + slots. Each number is taken modulo the period or the
/// tile.
struct ScheduleShift {
    int slots = 0;
    int rows = 0;
    int cols = 0;

    bool operator==(const ScheduleShift&) const = default;
};

/// The schedule of a chip that runs `schedule` with this shift.
[[nodiscard]] ExposureSchedule shifted_schedule(const ExposureSchedule& schedule,
                                                const ScheduleShift& shift);

/// One row of the array at the end of a slot.
struct RowInSlot {
    std::int64_t slot = 0;
    int row = 0;
    int cols = 0;
};

/// `visit_due_pixels` of the shifted schedule, without creating it. Precondition: 0 <= shift.slots
/// < period, 0 <= shift.rows, 0 <= shift.cols < tile columns.
template <typename Visit>
void visit_due_shifted(const ExposureSchedule& schedule, const ScheduleShift& shift,
                       const RowInSlot& at, Visit&& visit) {
    const auto phase = static_cast<int>((at.slot + shift.slots) % schedule.period_slots());
    const auto due = schedule.due(phase, (at.row + shift.rows) % schedule.tile_rows());
    const auto split = std::ranges::partition_point(
        due, [&](const DuePixel& pixel) { return pixel.col < shift.cols; });
    const auto visit_part = [&](auto begin, auto end, int tile_col) {
        for (auto pixel = begin; pixel != end; ++pixel) {
            const int col = tile_col + pixel->col;
            if (col >= at.cols) return;
            if (pixel->span_slots <= at.slot + 1) visit(col, *pixel);
        }
    };
    for (int tile_col = -shift.cols; tile_col < at.cols; tile_col += schedule.tile_cols()) {
        visit_part(split, due.end(), tile_col);
        visit_part(due.begin(), split, tile_col + schedule.tile_cols());
    }
}

}  // namespace stipple
