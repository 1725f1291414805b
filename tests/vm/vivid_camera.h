#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <variant>

#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_settings.h"

namespace stipple {

/// vivid's smallest webcam image, a pattern that does not move; `more` comes after, and wins.
inline CameraSettings still(const CameraSettings& more = {}) {
    CameraSettings settings{
        {"Input", "0"},    {"PixelFormat", "Mono8"}, {"Width", "320"},
        {"Height", "180"}, {"osd_text_mode", "2"},   {"gain_automatic", "0"},
        {"gain", "100"},   {"test_pattern", "20"},   {"AcquisitionFrameRate", "60"}};
    settings.insert(settings.end(), more.begin(), more.end());
    return settings;
}

inline std::unique_ptr<Camera> open_video(int number, const CameraSettings& settings,
                                          int frames = 4) {
    return open_v4l2_camera("v4l2:" + std::to_string(number), settings, {.frames = frames});
}

inline Arrival arrival_from(Camera& camera) {
    return camera.wait(std::chrono::seconds(20));  // the machine is emulated
}

inline CapturedFrame frame_from(Camera& camera) {
    Arrival arrival = arrival_from(camera);
    if (auto* const lost = std::get_if<DeviceLost>(&arrival))
        throw std::runtime_error("lost: " + lost->reason);
    return std::get<CapturedFrame>(std::move(arrival));
}

/// Sets a control of a camera, which may be streaming.
inline void control(int number, const char* name, const char* value = "1") {
    const V4l2Device device("/dev/video" + std::to_string(number));
    set_v4l2_controls(device, {{name, value}});
}

}  // namespace stipple
