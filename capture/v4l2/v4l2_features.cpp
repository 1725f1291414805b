#include <linux/videodev2.h>

#include "capture/v4l2/v4l2_camera.h"
#include "capture/v4l2/v4l2_device.h"
#include "capture/v4l2/v4l2_settings.h"

namespace stipple {
namespace {

std::string type_of(const V4l2Control& control) {
    switch (control.type) {
        case V4L2_CTRL_TYPE_BOOLEAN:
            return "boolean";
        case V4L2_CTRL_TYPE_MENU:
        case V4L2_CTRL_TYPE_INTEGER_MENU:
            return "choice";
        case V4L2_CTRL_TYPE_BUTTON:
            return "command";
        case V4L2_CTRL_TYPE_BITMASK:
            return "mask";
        default:
            return "integer";
    }
}

std::string access_of(const V4l2Control& control) {
    constexpr std::uint32_t kNotNow = V4L2_CTRL_FLAG_INACTIVE | V4L2_CTRL_FLAG_GRABBED;
    if ((control.flags & V4L2_CTRL_FLAG_WRITE_ONLY) != 0 || control.type == V4L2_CTRL_TYPE_BUTTON)
        return "wo";
    return (control.flags & (V4L2_CTRL_FLAG_READ_ONLY | kNotNow)) != 0 ? "ro" : "rw";
}

/// By the API; it has units for few controls.
std::string unit_of(const V4l2Control& control) {
    return control.id == V4L2_CID_EXPOSURE_ABSOLUTE ? "100 us" : "";
}

}  // namespace

std::vector<CameraFeature> v4l2_features(const std::string& address) {
    const V4l2Device device(v4l2_node_path(address));
    const auto values = read_v4l2_controls(device);
    std::vector<CameraFeature> features;
    for (const auto& [name, control] : v4l2_controls(device)) {
        CameraFeature feature{.name = name,
                              .type = type_of(control),
                              .access = access_of(control),
                              .unit = unit_of(control)};
        if (const auto value = values.find(name); value != values.end())
            feature.value = value->second;
        if (feature.type == "integer") {
            feature.minimum = std::to_string(control.minimum);
            feature.maximum = std::to_string(control.maximum);
            feature.increment = std::to_string(control.step);
        }
        for (const auto& entry : control.menu) feature.choices.push_back(entry.second);
        features.push_back(std::move(feature));
    }
    return features;
}

}  // namespace stipple
