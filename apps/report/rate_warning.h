#pragma once

#include <string>

#include "capture/frame_rate.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

// What is wrong where frames of another rate each become a slot of a sensor. Empty if the rates
// agree within 2 %, or if too few frames have come to say.

/// Of a camera at work.
[[nodiscard]] std::string camera_rate_warning(const FrameRate& frames, const SensorParams& sensor);

/// Of the recording of a camera.
[[nodiscard]] std::string recording_rate_warning(const std::string& file, const FrameRate& frames,
                                                 const SensorParams& sensor);

/// Of a video that has so many frames a second. It may be meant, as slow motion is.
[[nodiscard]] std::string video_rate_warning(const std::string& file, double frames_hz,
                                             const SensorParams& sensor);

}  // namespace stipple
