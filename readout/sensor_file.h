#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "readout/config_origin.h"
#include "readout/schedules/named_schedule.h"
#include "readout/timing/overrun_policy.h"
#include "readout/timing/readout_timing.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Names the files of a sensor and of its schedule, and the keys that differ from them. Names are
/// those of config/sensors and config/schedules.
struct SensorChoice {
    std::string sensor = "paper";                     ///< name or file
    std::string schedule = "random";                  ///< name, file, or compiled file (.mem, .hex)
    std::vector<std::string> settings = {};           ///< "key=value", laid over the sensor's file
    std::vector<std::string> schedule_settings = {};  ///< the same of the schedule
    std::uint64_t seed = 1;                           ///< of noise and schedule
    OverrunPolicy overrun = OverrunPolicy::kStretch;
};

/// Content of a sensor file.
struct SensorDescription {
    SensorParams params;
    std::optional<ReadoutTiming> timing = {};  ///< of the section [timing], if present
    std::optional<ConfigOrigin> origin = {};   ///< the file; none: made in code
};

/// All parameters that determine the samples of a sensor, with their origin. A program that changes
/// `params` or `timing` of a sensor file resets `origin`; one that replaces `schedule` replaces its
/// origin with it. The provenance of a stream then says that they were made in code.
struct SensorSetup {
    SensorParams params;
    NamedSchedule schedule;
    FrameShape shape;        ///< of the array: one plane if it has a colour filter array
    FrameShape footage;      ///< of the light
    std::uint64_t seed = 1;  ///< of noise and schedule
    std::optional<ReadoutTiming> timing = {};  ///< none: readout takes no time
    OverrunPolicy overrun = OverrunPolicy::kStretch;
    std::optional<ConfigOrigin> origin = {};  ///< file of `params` and `timing`; none: made in code
};

/// The chosen sensor. \throws InputError naming file, line and key of an unusable value.
[[nodiscard]] SensorDescription read_sensor_file(const SensorChoice& choice);

/// Message that a sensor has no section [timing], with the names of those that have one.
[[nodiscard]] std::string no_timing_text();

/// The chosen schedule, made for an array of `shape`. \throws InputError naming file, line and key
/// of an unusable value.
[[nodiscard]] NamedSchedule set_up_schedule(const SensorChoice& choice, FrameShape shape,
                                            const ColumnAddressing& addressing);

/// The parameters of a sensor without a schedule. \throws InputError naming file, line and key of
/// an unusable value.
[[nodiscard]] SensorParams set_up_params(const SensorChoice& choice);

/// A sensor for footage of this shape, which may be a mosaic already. \throws InputError naming
/// file, line and key of an unusable value, or if the sensor has a colour filter array but the
/// footage has no colour or another mosaic.
[[nodiscard]] SensorSetup set_up_sensor(const SensorChoice& choice, FrameShape footage,
                                        ColourFilter mosaic = ColourFilter::kNone);

/// The same for a sensor that was read before: `choice` names its schedule, seed and overrun
/// policy.
[[nodiscard]] SensorSetup set_up_sensor(const SensorDescription& sensor, const SensorChoice& choice,
                                        FrameShape footage,
                                        ColourFilter mosaic = ColourFilter::kNone);

/// Warning that a sensor without colour filter array treats this mosaic as mono; else empty.
[[nodiscard]] std::string mosaic_warning(const SensorSetup& setup, ColourFilter mosaic);

}  // namespace stipple
