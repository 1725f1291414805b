#include "readout/schedule_feasibility.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "readout/sensor_file.h"
#include "readout/timing/readout_cost.h"
#include "readout/timing/readout_rate.h"

namespace stipple {
namespace {

/// The first slot of the period in which more than `max_exposures` exposures of a pixel are under
/// way.
std::optional<std::size_t> crowded_slot(std::span<const Exposure> exposures, int period_slots,
                                        int max_exposures) {
    std::vector<int> under_way(static_cast<std::size_t>(period_slots), 0);
    for (const Exposure& e : exposures)
        for (std::size_t i = 0; i < static_cast<std::size_t>(e.span_slots()); ++i)
            ++under_way[(e.first_slot + i) % under_way.size()];
    for (std::size_t slot = 0; slot < under_way.size(); ++slot)
        if (under_way[slot] > max_exposures) return slot;
    return std::nullopt;
}

/// True if a steady slot has samples of the window.
bool reads_some_pixel(const ExposureSchedule& schedule, FrameShape shape) {
    const std::int64_t first = schedule.longest_span_slots();
    for (std::int64_t slot = first; slot < first + schedule.period_slots(); ++slot)
        if (count_due(schedule, slot, 0, shape.rows, shape.cols) > 0) return true;
    return false;
}

}  // namespace

std::optional<std::string> store_problem(const ExposureSchedule& schedule, int charge_stores) {
    if (schedule.charge_stores() <= charge_stores) return std::nullopt;
    for (int row = 0; row < schedule.tile_rows(); ++row)
        for (int col = 0; col < schedule.tile_cols(); ++col)
            if (const auto slot = crowded_slot(schedule.exposures(row, col),
                                               schedule.period_slots(), charge_stores))
                return fmt::format(
                    "pixel ({}, {}) slot {}: exposures interleave; this schedule needs {} charge "
                    "stores per pixel, the sensor has {}{}",
                    row, col, *slot, schedule.charge_stores(), charge_stores,
                    schedule.charge_stores() == 2 ? " (its key charge_stores=2 gives it two)"
                                                  : ", and two is the most that can be emulated");
    return std::nullopt;
}

std::optional<std::string> timing_problem(const ExposureSchedule& schedule,
                                          const ReadoutTiming& timing, FrameShape shape,
                                          double slot_us) {
    const std::int64_t budget = slot_clocks(timing, slot_us);
    if (!reads_some_pixel(schedule, shape)) return std::nullopt;
    const ReadoutRate rate = rate_of(timing, schedule, shape, budget);
    if (rate.min_slot_clocks <= static_cast<double>(budget)) return std::nullopt;
    const double clocks_per_us = static_cast<double>(timing.clock_hz) / 1e6;
    return fmt::format(
        "slot {}: reading {} samples takes {:.6g} us and must end within {} {} of {:.6g} us; this "
        "needs slots of {:.6g} us, limited by {}",
        rate.slowest_phase, rate.slowest.counts.samples,
        static_cast<double>(rate.slowest.counts.readout_clocks) / clocks_per_us,
        rate.deadline_slots, rate.deadline_slots == 1 ? "slot" : "slots", slot_us,
        rate.min_slot_clocks / clocks_per_us, name_of(rate.slowest.limit));
}

std::optional<std::string> schedule_problem(const SensorSetup& setup) {
    const ExposureSchedule& schedule = setup.schedule.schedule;
    auto problem = store_problem(schedule, setup.params.charge_stores);
    if (setup.timing && !problem)
        problem = timing_problem(schedule, *setup.timing, setup.shape, setup.params.slot_us);
    return problem;
}

std::optional<std::string> group_remark(const ExposureSchedule& schedule,
                                        const ColumnAddressing& addressing, FrameShape shape) {
    if (addressing.kind != ColumnAddressing::Kind::kGroup) return std::nullopt;
    const auto exposures_of = [&](int row, int col) {
        return schedule.exposures(row % schedule.tile_rows(), col % schedule.tile_cols());
    };
    const int rows = std::min(shape.rows, std::lcm(schedule.tile_rows(), addressing.group_rows));
    const int cols = std::min(shape.cols, std::lcm(schedule.tile_cols(), addressing.group_cols));
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col)
            if (!std::ranges::equal(exposures_of(row, col),
                                    exposures_of(row - row % addressing.group_rows,
                                                 col - col % addressing.group_cols)))
                return fmt::format(
                    "pixel ({}, {}) has exposures of its own in a group of {} x {} pixels, which "
                    "is "
                    "transferred whole whenever one of them is due",
                    row, col, addressing.group_rows, addressing.group_cols);
    return std::nullopt;
}

}  // namespace stipple
