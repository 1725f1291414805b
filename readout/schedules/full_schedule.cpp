#include "readout/schedules/full_schedule.h"

#include <fmt/format.h>

#include "core/error.h"

namespace stipple {

ExposureSchedule full_schedule(int open_slots, int period_slots) {
    if (open_slots < 1 || open_slots > kMaxExposureSlots || open_slots > period_slots)
        throw InputError("exposure schedule",
                         fmt::format("{} open slots in a period of {}: needs 1 to {} open slots "
                                     "and a period not shorter",
                                     open_slots, period_slots, kMaxExposureSlots));
    return {1, 1, period_slots, {0, 1}, {{0, open_without_gap(open_slots)}}};
}

}  // namespace stipple
