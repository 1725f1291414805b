#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "capture/camera.h"
#include "capture/v4l2/v4l2_device.h"

namespace stipple {

/// A control of a V4L2 device.
struct V4l2Control {
    std::uint32_t id = 0;
    std::string name;  ///< as v4l2-ctl writes it: "exposure_time_absolute"
    std::uint32_t type = 0;
    std::uint32_t flags = 0;
    std::int64_t minimum = 0;
    std::int64_t maximum = 0;
    std::uint64_t step = 1;
    std::map<std::int64_t, std::string> menu;  ///< values of a menu
};

/// The controls that have one number as value, or none (buttons); by name.
[[nodiscard]] std::map<std::string, V4l2Control> v4l2_controls(const V4l2Device& device);

/// Sets controls in the order given, each by name to a whole number, or to the text of a menu
/// entry. `ExposureTime` is in microseconds; exposure is set to manual first. \throws InputError if
/// there is no such control or value; DeviceError if the device refuses
void set_v4l2_controls(const V4l2Device& device, const CameraSettings& settings);

/// The present values of all controls that can be read, as text; menus by their text.
[[nodiscard]] std::map<std::string, std::string> read_v4l2_controls(const V4l2Device& device);

/// Settings of the exposure, where the device has such controls and does not vary them by itself.
struct V4l2Exposure {
    std::optional<double> exposure_us;
    std::optional<double> gain;  ///< in the unit of the device
    std::optional<double> black_level_dn;
};
[[nodiscard]] V4l2Exposure read_v4l2_exposure(const V4l2Device& device);

}  // namespace stipple
