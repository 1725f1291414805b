#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <variant>
#include <vector>

#include "capture/v4l2/v4l2_camera.h"
#include "tests/capture/v4l2/emulated_v4l2.h"

namespace stipple {

inline std::vector<std::uint8_t> ramp(std::size_t size, int first) {
    std::vector<std::uint8_t> bytes(size);
    std::iota(bytes.begin(), bytes.end(), static_cast<std::uint8_t>(first));
    return bytes;
}

inline EmulatedFrame ramp_frame(std::size_t size, int number) {
    EmulatedFrame frame;
    frame.content = ramp(size, 7 * number);
    frame.sequence = static_cast<std::uint32_t>(number);
    return frame;
}

inline std::unique_ptr<Camera> open_emulated(const CameraSettings& settings = {}, int frames = 4) {
    return open_v4l2_camera("v4l2:/dev/video0", settings, {.frames = frames});
}

inline CapturedFrame frame_from(Camera& camera) {
    Arrival arrival = camera.wait(std::chrono::seconds(5));
    if (auto* const lost = std::get_if<DeviceLost>(&arrival))
        throw std::runtime_error("lost: " + lost->reason);
    return std::get<CapturedFrame>(std::move(arrival));
}

}  // namespace stipple
