#include "decoder/schedule_check/schedule_shift.h"

#include <utility>
#include <vector>

namespace stipple {
namespace {

int modulo(int value, int range) {
    return (value % range + range) % range;
}

}  // namespace

ExposureSchedule shifted_schedule(const ExposureSchedule& schedule, const ScheduleShift& shift) {
    const int rows = schedule.tile_rows();
    const int cols = schedule.tile_cols();
    const int period = schedule.period_slots();
    std::vector<std::uint32_t> first{0};
    std::vector<Exposure> exposures;
    for (int row = 0; row < rows; ++row)
        for (int col = 0; col < cols; ++col) {
            for (Exposure e : schedule.exposures(modulo(row + shift.rows, rows),
                                                 modulo(col + shift.cols, cols))) {
                const int first_slot = static_cast<int>(e.first_slot) - shift.slots % period;
                e.first_slot = static_cast<std::uint32_t>(modulo(first_slot, period));
                exposures.push_back(e);
            }
            first.push_back(static_cast<std::uint32_t>(exposures.size()));
        }
    return {rows, cols, period, std::move(first), std::move(exposures)};
}

}  // namespace stipple
