#pragma once

#include <cstdint>
#include <map>
#include <optional>
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

/// A control of a V4L2 device.
struct V4l2Control {
    std::uint32_t id = 0;
    std::string name;  ///< as in v4l2-ctl: "exposure_time_absolute"
    std::uint32_t type = 0;
    std::uint32_t flags = 0;
    std::int64_t minimum = 0;
    std::int64_t maximum = 0;
    std::uint64_t step = 1;
    std::map<std::int64_t, std::string> menu;  ///< values of a menu
};

/// The controls with one number as value, or without a value (buttons), by name.
[[nodiscard]] std::map<std::string, V4l2Control> v4l2_controls(const V4l2Device& device);

/// Sets controls by name in the given order. A value is an integer or the text of a menu entry.
/// `ExposureTime` is in microseconds; exposure is set to manual first. \throws InputError if there
/// is no such control or value; DeviceError if the device refuses
void set_v4l2_controls(const V4l2Device& device, const CameraSettings& settings);

/// The current values of all readable controls as text; menus by the text of their entry.
[[nodiscard]] std::map<std::string, std::string> read_v4l2_controls(const V4l2Device& device);

/// Settings of the exposure; empty if the device has no such control or varies it by itself.
struct V4l2Exposure {
    std::optional<double> exposure_us;
    std::optional<double> gain;  ///< in the unit of the device
    std::optional<double> black_level_dn;
};
[[nodiscard]] V4l2Exposure read_v4l2_exposure(const V4l2Device& device);

}  // namespace stipple
