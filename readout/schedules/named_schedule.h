#pragma once

#include <optional>
#include <string>

#include "core/exposure_schedule.h"
#include "readout/config_origin.h"
#include "stream/stream_header.h"

namespace stipple {

/// A schedule with what a stream header says of it.
struct NamedSchedule {
    std::string name;
    ScheduleSource source;
    ExposureSchedule schedule;
    std::optional<ConfigOrigin> origin = {};  ///< its file; none: made in code
};

}  // namespace stipple
