#pragma once

#include <string>

#include "capture/frame_sequence.h"
#include "core/message.h"
#include "io/image.h"
#include "sensor_model/sensor_params.h"

namespace stipple {

// Warnings that frame rate or exposure time of footage do not suit the slots of the sensor. Empty
// if the rates agree within 2 %, or if there are too few frames for a rate.

/// Warning for a running camera.
[[nodiscard]] Message camera_rate_warning(const FrameRate& frames, const SensorParams& sensor);

/// Warning for the recording of a camera.
[[nodiscard]] Message recording_rate_warning(const std::string& file, const FrameRate& frames,
                                             const SensorParams& sensor);

/// Warning for a video. The difference may be intended, as in slow motion.
[[nodiscard]] Message video_rate_warning(const std::string& file, double frames_hz,
                                         const SensorParams& sensor);

/// Warning for footage whose exposure time is longer than a slot; else empty.
[[nodiscard]] std::string exposure_warning(const std::string& file, double exposure_us,
                                           const SensorParams& sensor);

/// Warning that a camera file has its black level elsewhere than a sensor of as many bits, by more
/// than a DN; else empty. Numbers of other bits do not compare, and a sensor in paper mode has no
/// black level.
[[nodiscard]] Message black_level_warning(const std::string& file, const SourceInfo& footage,
                                          const SensorParams& sensor);

}  // namespace stipple
