#include "readout/schedules/cell_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <numeric>

#include "core/error.h"
#include "readout/schedules/schedule_builder.h"
#include "stream/stream_header.h"

namespace stipple {
namespace {

std::int64_t period_of(const Cell& cell) {
    std::int64_t period = 1;
    for (const int every : cell.every_slots) {
        period = std::lcm(period, std::int64_t{every});
        if (period > kMaxPeriodSlots)
            throw InputError("cell", fmt::format("all pixels together repeat after {} slots or "
                                                 "more; {} are the most",
                                                 period, kMaxPeriodSlots));
    }
    return period;
}

}  // namespace

ExposureSchedule cell_schedule(const Cell& cell) {
    const auto pixels = static_cast<std::size_t>(cell.rows) * static_cast<std::size_t>(cell.cols);
    assert(cell.exposure_slots.size() == pixels && cell.every_slots.size() == pixels &&
           cell.first_slots.size() == pixels);
    const std::int64_t period = period_of(cell);
    std::int64_t exposures = 0;
    for (const int every : cell.every_slots) exposures += period / every;
    if (exposures > static_cast<std::int64_t>(kMaxTileExposures))
        throw InputError("cell", fmt::format("the period of {} slots has {} exposures; 2^24 fit a "
                                             "stream",
                                             period, exposures));
    ScheduleBuilder list(cell.rows, cell.cols, static_cast<int>(period));
    for (std::size_t p = 0; p < pixels; ++p) {
        if (cell.exposure_slots[p] > cell.every_slots[p])
            throw InputError(
                "cell", fmt::format("pixel ({}, {}) slot {}: an exposure of {} slots every {}",
                                    p / static_cast<std::size_t>(cell.cols),
                                    p % static_cast<std::size_t>(cell.cols), cell.first_slots[p],
                                    cell.exposure_slots[p], cell.every_slots[p]));
        for (std::int64_t slot = 0; slot < period; slot += cell.every_slots[p])
            list.add_open(static_cast<std::uint32_t>(slot + cell.first_slots[p]),
                          cell.exposure_slots[p]);
        list.end_pixel();
    }
    return std::move(list).schedule();
}

ExposureSchedule rolling_schedule(const RollingShutter& shutter, int array_rows) {
    const auto [exposure_slots, period_slots, rows_per_slot] = shutter;
    if (exposure_slots < 1 || exposure_slots > kMaxExposureSlots || exposure_slots > period_slots ||
        period_slots > kMaxPeriodSlots || rows_per_slot < 1 || array_rows < 1)
        throw InputError("rolling shutter",
                         fmt::format("{} slots of {}, {} rows a slot: needs exposures of 1 to 64 "
                                     "slots, periods of these to {}, and 1 row or more",
                                     exposure_slots, period_slots, rows_per_slot, kMaxPeriodSlots));
    const auto rows = static_cast<int>(
        std::min<std::int64_t>(std::int64_t{period_slots} * rows_per_slot, array_rows));
    ScheduleBuilder list(rows, 1, period_slots);
    for (int row = 0; row < rows; ++row) {
        list.add_open(static_cast<std::uint32_t>(row / rows_per_slot), exposure_slots);
        list.end_pixel();
    }
    return std::move(list).schedule();
}

}  // namespace stipple
