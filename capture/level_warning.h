#pragma once

#include <string>

#include "core/message.h"
#include "io/image.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

/// Warning that a camera file has its black level elsewhere than a sensor of as many bits, by more
/// than a DN; else empty. Numbers of other bits do not compare, and a sensor in paper mode has no
/// black level.
[[nodiscard]] Message black_level_warning(const std::string& file, const SourceInfo& footage,
                                          const SensorParams& sensor);

}  // namespace stipple
