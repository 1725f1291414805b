#pragma once

#include <string>
#include <vector>

#include "capture/recording/read_ahead.h"
#include "core/message.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

// What the user should know of footage, as warnings. Messages call the footage `name`.

/// How its frames suit the slots and levels of a sensor: frame rate (unless `resampled`), exposure
/// time, black level. Before the first frame; the rate of a recording is known at its end.
[[nodiscard]] std::vector<Message> sensor_notes(const std::string& name, const ReadAhead& footage,
                                                const SensorParams& sensor, bool resampled);

/// Faults of a recording that was read to its end: damage, no end, missing or incomplete frames.
/// Empty if it has none, if it was not read to its end, and for other footage.
[[nodiscard]] std::string recording_note(const std::string& name, const ReadAhead& footage);

/// The same and, unless `resampled`, that its frame rate is not that of the slots.
[[nodiscard]] std::vector<Message> end_notes(const std::string& name, const ReadAhead& footage,
                                             const SensorParams& sensor, bool resampled);

}  // namespace stipple
