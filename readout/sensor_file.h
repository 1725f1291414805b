#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"
#include "readout/schedules/schedule_catalogue.h"
#include "readout/timing/readout_account.h"
#include "readout/timing/readout_timing.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// A sensor as the command line describes it.
struct SensorChoice {
    std::string sensor = "paper";            ///< name or file
    std::string schedule = "random";         ///< name, file, or compiled file (.mem, .hex)
    std::vector<std::string> settings = {};  ///< "key=value" of the sensor
    std::vector<std::string> schedule_settings = {};
    std::uint64_t seed = 1;  ///< of noise and schedule
    OverrunPolicy overrun = OverrunPolicy::kStretch;
};

/// What a sensor file says.
struct SensorDescription {
    SensorParams params;
    std::optional<ReadoutTiming> timing;  ///< if it has a section [timing]
};

/// All that decides what a sensor makes of light.
struct SensorSetup {
    SensorParams params;
    NamedSchedule schedule;
    FrameShape shape;    ///< of the array: one plane if it has a colour filter array
    FrameShape footage;  ///< of the light
    std::uint64_t seed = 1;
    std::optional<ReadoutTiming> timing = {};
    OverrunPolicy overrun = OverrunPolicy::kStretch;
    SensorChoice choice = {};  ///< that it was made of
};

/// The chosen sensor. \throws InputError naming file, line and key of what cannot be used.
[[nodiscard]] SensorDescription read_sensor_file(const SensorChoice& choice);

/// Says that a sensor has no section [timing], and which ones have.
[[nodiscard]] std::string no_timing_text();

/// The chosen schedule, made for an array of `shape`. \throws InputError naming file, line and key
/// of what cannot be used.
[[nodiscard]] NamedSchedule set_up_schedule(const SensorChoice& choice, FrameShape shape,
                                            const ColumnAddressing& addressing);

/// The keys of the sensor's section [timing], and of the schedule (none of a compiled one), as they
/// were chosen: lines of TOML.
[[nodiscard]] std::string timing_keys(const SensorChoice& choice);
[[nodiscard]] std::string schedule_keys(const SensorChoice& choice);

/// The parameters of a sensor that has no schedule. \throws InputError naming file, line and key of
/// what cannot be used.
[[nodiscard]] SensorParams set_up_params(const SensorChoice& choice);

/// A sensor for this footage, which may be a mosaic of colours already. \throws InputError naming
/// file, line and key of what cannot be used, or if there is a colour filter array but no colour,
/// or another mosaic than that of the footage.
[[nodiscard]] SensorSetup set_up_sensor(const SensorChoice& choice, FrameShape footage,
                                        ColourFilter mosaic = ColourFilter::kNone);

/// Says what such a mosaic becomes if the sensor has no colour filter array; else empty.
[[nodiscard]] std::string mosaic_warning(const SensorSetup& setup, ColourFilter mosaic);

}  // namespace stipple
