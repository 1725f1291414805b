#pragma once

#include <string>

#include "capture/frame_rate.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

// Warnings that the frame rate of footage differs from the slot rate of the sensor. Empty if the
// rates agree within 2 %, or if too few frames have come to tell.

/// Of a camera at work.
[[nodiscard]] std::string camera_rate_warning(const FrameRate& frames, const SensorParams& sensor);

/// Of the recording of a camera.
[[nodiscard]] std::string recording_rate_warning(const std::string& file, const FrameRate& frames,
                                                 const SensorParams& sensor);

/// Of a video that has so many frames a second. It may be meant, as slow motion is.
[[nodiscard]] std::string video_rate_warning(const std::string& file, double frames_hz,
                                             const SensorParams& sensor);

/// Of footage whose frames were exposed for longer than a slot; else empty.
[[nodiscard]] std::string exposure_warning(const std::string& file, double exposure_us,
                                           const SensorParams& sensor);

}  // namespace stipple
