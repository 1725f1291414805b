#include "capture/v4l2/v4l2_settings.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <string_view>

#include "capture/camera.h"
#include "core/error.h"
#include "core/text.h"

namespace stipple {
namespace {

constexpr double kExposureUnitUs = 100;  // of V4L2_CID_EXPOSURE_ABSOLUTE, by the API

/// As v4l2-ctl does it: letters and digits in lower case, one '_' for each run of others.
std::string control_name(std::string_view title) {
    std::string name;
    for (const char c : title) {
        const auto letter = static_cast<unsigned char>(c);
        if (std::isalnum(letter) != 0)
            name += static_cast<char>(std::tolower(letter));
        else if (!name.empty() && name.back() != '_')
            name += '_';
    }
    return name;
}

bool is_read_here(const v4l2_query_ext_ctrl& about) {
    if ((about.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_HAS_PAYLOAD)) != 0) return false;
    switch (about.type) {
        case V4L2_CTRL_TYPE_INTEGER:
        case V4L2_CTRL_TYPE_BOOLEAN:
        case V4L2_CTRL_TYPE_MENU:
        case V4L2_CTRL_TYPE_INTEGER_MENU:
        case V4L2_CTRL_TYPE_BITMASK:
        case V4L2_CTRL_TYPE_INTEGER64:
        case V4L2_CTRL_TYPE_BUTTON:
            return true;
        default:
            return false;
    }
}

std::map<std::int64_t, std::string> menu_of(const V4l2Device& device,
                                            const v4l2_query_ext_ctrl& about) {
    std::map<std::int64_t, std::string> menu;
    const bool numbers = about.type == V4L2_CTRL_TYPE_INTEGER_MENU;
    if (!numbers && about.type != V4L2_CTRL_TYPE_MENU) return menu;
    constexpr std::int64_t kMaxChoices = 1000;
    const std::int64_t last = std::min<std::int64_t>(about.maximum, about.minimum + kMaxChoices);
    for (std::int64_t i = about.minimum; i <= last; ++i) {
        v4l2_querymenu item{};
        item.id = about.id;
        item.index = static_cast<__u32>(i);
        if (device.call(VIDIOC_QUERYMENU, &item) != 0) continue;  // menus may have holes
        if (numbers) {
            menu[i] = std::to_string(static_cast<std::int64_t>(item.value));
        } else {
            char text[sizeof item.name + 1] = {};
            std::memcpy(text, item.name, sizeof item.name);
            menu[i] = text;
        }
    }
    return menu;
}

std::optional<std::int64_t> read_value(const V4l2Device& device, const V4l2Control& control) {
    constexpr std::uint32_t kMute = V4L2_CTRL_FLAG_WRITE_ONLY;
    if ((control.flags & kMute) != 0 || control.type == V4L2_CTRL_TYPE_BUTTON) return std::nullopt;
    v4l2_ext_control value{};
    value.id = control.id;
    v4l2_ext_controls request{};
    request.which = V4L2_CTRL_WHICH_CUR_VAL;
    request.count = 1;
    request.controls = &value;
    if (device.call(VIDIOC_G_EXT_CTRLS, &request) != 0) return std::nullopt;
    if (control.type == V4L2_CTRL_TYPE_INTEGER64) return std::int64_t{value.value64};
    // A mask uses all 32 bits, the sign is none.
    if (control.type == V4L2_CTRL_TYPE_BITMASK) return static_cast<std::uint32_t>(value.value);
    return std::int64_t{value.value};
}

class ControlSetter {
  public:
    explicit ControlSetter(const V4l2Device& device)
        : device_(device), controls_(v4l2_controls(device)) {}

    void set(const std::string& name, const std::string& text) const {
        if (name == "ExposureTime") return set_exposure(text);
        const auto found = controls_.find(name);
        if (found == controls_.end()) refuse(name, "the device has no such setting; " + offer());
        write(found->second, value_of(found->second, text));
    }

  private:
    [[noreturn]] void refuse(std::string_view name, std::string_view why) const {
        throw InputError(device_.address(), fmt::format("{}: {}", name, why));
    }

    [[nodiscard]] std::string offer() const {
        std::vector<std::string> names;
        for (const auto& entry : controls_) names.push_back(entry.first);
        return names.empty() ? "it has no controls" : "its controls are " + joined(names);
    }

    [[nodiscard]] const V4l2Control* with_id(std::uint32_t id) const {
        for (const auto& entry : controls_)
            if (entry.second.id == id) return &entry.second;
        return nullptr;
    }

    [[nodiscard]] std::int64_t value_of(const V4l2Control& control, const std::string& text) const {
        if (control.type == V4L2_CTRL_TYPE_BUTTON) return 1;
        for (const auto& [value, entry] : control.menu)
            if (control.type == V4L2_CTRL_TYPE_MENU && entry == text) return value;
        const auto value = integer_setting(text);
        if (!control.menu.empty()) {
            if (value && control.menu.count(*value) != 0) return *value;
            std::vector<std::string> entries;
            for (const auto& [number, entry] : control.menu)
                entries.push_back(fmt::format("{} ({})", number, entry));
            refuse(control.name, fmt::format("\"{}\" is none of {}", text, joined(entries)));
        }
        const bool mask = control.type == V4L2_CTRL_TYPE_BITMASK;
        const std::int64_t min = mask ? 0 : control.minimum;
        const std::int64_t max = mask ? std::int64_t{0xFFFFFFFF} : control.maximum;
        if (!value || *value < min || *value > max)
            refuse(control.name,
                   fmt::format("\"{}\" is not a whole number from {} to {}", text, min, max));
        const auto above = static_cast<std::uint64_t>(*value) - static_cast<std::uint64_t>(min);
        if (!mask && control.step > 1 && above % control.step != 0)
            refuse(control.name,
                   fmt::format("\"{}\" is not {} plus a multiple of {}", text, min, control.step));
        return *value;
    }

    void write(const V4l2Control& control, std::int64_t wanted) const {
        if ((control.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0)
            refuse(control.name, "the device lets it be read only");
        v4l2_ext_control value{};
        value.id = control.id;
        if (control.type == V4L2_CTRL_TYPE_INTEGER64)
            value.value64 = wanted;
        else
            value.value = static_cast<__s32>(wanted);
        v4l2_ext_controls request{};
        request.which = V4L2_CTRL_WHICH_CUR_VAL;
        request.count = 1;
        request.controls = &value;
        device_.demand(VIDIOC_S_EXT_CTRLS, &request,
                       fmt::format("set {} to {}", control.name, wanted));
        if (control.type == V4L2_CTRL_TYPE_BUTTON) return;
        const auto got = read_value(device_, control);
        const auto asked = control.type == V4L2_CTRL_TYPE_BITMASK
                               ? static_cast<std::int64_t>(static_cast<std::uint32_t>(wanted))
                               : wanted;
        constexpr std::uint32_t kOwnWill = V4L2_CTRL_FLAG_VOLATILE;
        if (got && *got != asked && (control.flags & kOwnWill) == 0)
            throw DeviceError(device_.address(), fmt::format("{}: the device takes {} for {}",
                                                             control.name, *got, asked));
    }

    void set_exposure(const std::string& text) const {
        const V4l2Control* const exposure = with_id(V4L2_CID_EXPOSURE_ABSOLUTE);
        if (exposure == nullptr)
            refuse("ExposureTime", "the device has no exposure in microseconds; " + offer());
        const auto wanted = number_setting(text);
        const auto min = static_cast<double>(exposure->minimum) * kExposureUnitUs;
        const auto max = static_cast<double>(exposure->maximum) * kExposureUnitUs;
        if (!wanted || !(*wanted >= min && *wanted <= max))
            refuse("ExposureTime",
                   fmt::format("\"{}\" is not a number from {} to {} us", text, min, max));
        const double units = std::round(*wanted / kExposureUnitUs);
        if (units * kExposureUnitUs != *wanted)
            refuse("ExposureTime",
                   fmt::format("{} us: the device counts in {} us", text, kExposureUnitUs));
        if (const V4l2Control* const automatic = with_id(V4L2_CID_EXPOSURE_AUTO))
            write(*automatic, V4L2_EXPOSURE_MANUAL);
        write(*exposure, value_of(*exposure, fmt::format("{:.0f}", units)));
    }

    const V4l2Device& device_;
    std::map<std::string, V4l2Control> controls_;
};

}  // namespace

std::map<std::string, V4l2Control> v4l2_controls(const V4l2Device& device) {
    std::map<std::string, V4l2Control> controls;
    v4l2_query_ext_ctrl about{};
    for (std::uint32_t last = 0;;) {
        about = {};
        about.id = last | V4L2_CTRL_FLAG_NEXT_CTRL;
        if (device.call(VIDIOC_QUERY_EXT_CTRL, &about) != 0 || about.id <= last) return controls;
        last = about.id;
        if (!is_read_here(about)) continue;
        const std::string name =
            control_name({about.name, ::strnlen(about.name, sizeof about.name)});
        controls[name] = {about.id,      name,          about.type, about.flags,
                          about.minimum, about.maximum, about.step, menu_of(device, about)};
    }
}

void set_v4l2_controls(const V4l2Device& device, const CameraSettings& settings) {
    if (settings.empty()) return;
    const ControlSetter setter(device);
    for (const auto& [name, value] : settings) setter.set(name, value);
}

std::map<std::string, std::string> read_v4l2_controls(const V4l2Device& device) {
    std::map<std::string, std::string> values;
    for (const auto& [name, control] : v4l2_controls(device)) {
        const auto value = read_value(device, control);
        if (!value) continue;
        const auto entry = control.menu.find(*value);
        values[name] = entry == control.menu.end() ? std::to_string(*value) : entry->second;
    }
    return values;
}

V4l2Exposure read_v4l2_exposure(const V4l2Device& device) {
    std::map<std::uint32_t, std::int64_t> values;
    for (const auto& entry : v4l2_controls(device))
        if (const auto value = read_value(device, entry.second)) values[entry.second.id] = *value;
    const auto value_of = [&](std::uint32_t id) -> std::optional<double> {
        const auto found = values.find(id);
        if (found == values.end()) return std::nullopt;
        return static_cast<double>(found->second);
    };
    V4l2Exposure exposure;
    const auto mode = values.find(V4L2_CID_EXPOSURE_AUTO);
    const bool fixed = mode == values.end() || mode->second == V4L2_EXPOSURE_MANUAL ||
                       mode->second == V4L2_EXPOSURE_SHUTTER_PRIORITY;
    const auto units = value_of(V4L2_CID_EXPOSURE_ABSOLUTE);
    if (fixed && units) exposure.exposure_us = *units * kExposureUnitUs;
    if (value_of(V4L2_CID_AUTOGAIN).value_or(0) == 0) {
        exposure.gain = value_of(V4L2_CID_ANALOGUE_GAIN);
        if (!exposure.gain) exposure.gain = value_of(V4L2_CID_GAIN);
    }
    exposure.black_level_dn = value_of(V4L2_CID_BLACK_LEVEL);
    return exposure;
}

}  // namespace stipple
