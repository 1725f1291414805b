#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/v4l2/v4l2_device.h"

namespace stipple {

/// What a V4L2 device was set to deliver.
struct V4l2Format {
    FrameLayout layout;
    std::size_t buffer_bytes = 0;              ///< of a buffer, as the driver wants it
    double frames_per_s = 0;                   ///< 0: the driver does not say
    std::map<std::string, std::string> facts;  ///< input, crop rectangle
};

/// Applies those of `settings` that are about pictures (is_v4l2_format_setting) and reads back what
/// came of it. A driver that answers with another format, size, region or rate than asked for is
/// refused: nothing is converted or scaled behind the user's back.
/// \throws InputError for values that cannot be meant, DeviceError for those that the device lacks
[[nodiscard]] V4l2Format set_v4l2_format(const V4l2Device& device, const CameraSettings& settings);

/// Whether a setting is one of Input, Width, Height, OffsetX, OffsetY, PixelFormat and
/// AcquisitionFrameRate; the others are controls.
[[nodiscard]] bool is_v4l2_format_setting(const std::string& name);

/// Names of those formats of the device that are in `pixel_formats()`, in the driver's order.
[[nodiscard]] std::vector<std::string> v4l2_format_names(const V4l2Device& device);

}  // namespace stipple
