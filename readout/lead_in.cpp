#include "readout/lead_in.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/error.h"
#include "readout/sensor_file.h"

namespace stipple {

std::int64_t lead_in_slots(const SensorSetup& setup) {
    const PhysicalTerms none;
    const PhysicalTerms& terms =
        setup.params.mode == SensorMode::kPhysical ? setup.params.physical : none;
    const auto refuse = [&](const char* key, double value) {
        if (value == 0) return;
        throw InputError(fmt::format("sensor {}", setup.params.name),
                         fmt::format("has {} = {}, by which each slot depends on all before it; "
                                     "emulate it in one run, or set sensor.{}=0",
                                     key, value, key));
    };
    refuse("lag", terms.lag);
    refuse("blooming", terms.blooming);
    const ExposureSchedule& schedule = setup.schedule.schedule;
    const std::int64_t span = std::max(schedule.longest_span_slots(), 1);
    // Row skew mixes the frame before into each frame.
    const std::int64_t skew = terms.row_skew_slots == 0 ? 0 : 1;
    if (terms.parasitic_light_sensitivity == 0) return span - 1 + skew;
    // A closed store collects light since it was last read: a period ago at most, and two where
    // the exposures of a pixel alternate between two stores.
    return std::int64_t{schedule.period_slots()} * schedule.charge_stores() + span + skew;
}

}  // namespace stipple
