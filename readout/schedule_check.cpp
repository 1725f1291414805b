#include "readout/schedule_check.h"

#include <fmt/format.h>

#include <vector>

namespace stipple {
namespace {

/// The first slot of the period in which more than `most` exposures of a pixel are under way.
std::optional<std::size_t> crowded_slot(std::span<const Exposure> exposures, int period_slots,
                                        int most) {
    std::vector<int> under_way(static_cast<std::size_t>(period_slots), 0);
    for (const Exposure& e : exposures)
        for (std::size_t i = 0; i < static_cast<std::size_t>(e.span_slots()); ++i)
            ++under_way[(e.first_slot + i) % under_way.size()];
    for (std::size_t slot = 0; slot < under_way.size(); ++slot)
        if (under_way[slot] > most) return slot;
    return std::nullopt;
}

}  // namespace

std::optional<std::string> store_problem(const ExposureSchedule& schedule, int charge_stores) {
    if (schedule.charge_stores() <= charge_stores) return std::nullopt;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            if (const auto slot = crowded_slot(schedule.exposures(row, col),
                                               schedule.period_slots(), charge_stores))
                return fmt::format(
                    "pixel ({}, {}) slot {}: exposures interleave; this schedule takes {} charge "
                    "stores per pixel, the sensor has {}{}",
                    row, col, *slot, schedule.charge_stores(), charge_stores,
                    schedule.charge_stores() == 2 ? " (--set charge_stores=2 gives it two)"
                                                  : ", and two is the most that can be emulated");
    return std::nullopt;
}

}  // namespace stipple
