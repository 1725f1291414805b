#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/v4l2/v4l2_device.h"

namespace stipple {

/// Format of the frames of a V4L2 device.
struct V4l2Format {
    FrameLayout layout;
    std::size_t buffer_bytes = 0;              ///< size of a buffer, as the driver requires
    double frames_hz = 0;                      ///< 0: unknown
    std::map<std::string, std::string> facts;  ///< input, crop rectangle
};

/// Applies the settings of the format (is_v4l2_format_setting) and reads the result back. Another
/// format, size, region or rate than requested is an error: frames are never converted or scaled
/// silently. \throws InputError for impossible values, DeviceError for values that the device lacks
[[nodiscard]] V4l2Format set_v4l2_format(const V4l2Device& device, const CameraSettings& settings);

/// Whether a setting is one of Input, Width, Height, OffsetX, OffsetY, PixelFormat and
/// AcquisitionFrameRate; the others are controls.
[[nodiscard]] bool is_v4l2_format_setting(const std::string& name);

/// Names of those formats of the device that are in `pixel_formats()`, in the driver's order.
[[nodiscard]] std::vector<std::string> v4l2_format_names(const V4l2Device& device);

}  // namespace stipple
