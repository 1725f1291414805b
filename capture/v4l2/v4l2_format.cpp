#include "capture/v4l2/v4l2_settings.h"

#include <fmt/format.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string_view>

#include "capture/camera.h"
#include "core/error.h"
#include "core/geometry.h"
#include "core/text.h"

namespace stipple {
namespace {

constexpr std::array<std::string_view, 7> kFormatSettings{
    "Input", "Width", "Height", "OffsetX", "OffsetY", "PixelFormat", "AcquisitionFrameRate"};

const std::string* value_of(const CameraSettings& settings, std::string_view name) {
    // The last one wins, as on a command line.
    const auto found = std::find_if(settings.rbegin(), settings.rend(),
                                    [&](const auto& setting) { return setting.first == name; });
    return found == settings.rend() ? nullptr : &found->second;
}

std::string fourcc_text(std::uint32_t code) {
    std::string text;
    for (int i = 0; i < 4; ++i) text += static_cast<char>(code >> (8 * i) & 0x7FU);
    return (code >> 31U) != 0 ? text + "-BE" : text;
}

/// The image part of a v4l2_format, the same for both APIs.
struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::uint32_t fourcc = 0;
    std::uint32_t field = 0;
    std::uint32_t planes = 1;
    std::uint32_t stride_bytes = 0;
    std::uint32_t buffer_bytes = 0;
};

Image image_of(const v4l2_format& format, bool multi_planar) {
    if (!multi_planar) {
        const v4l2_pix_format& pix = format.fmt.pix;
        return {pix.width, pix.height,       pix.pixelformat, pix.field,
                1,         pix.bytesperline, pix.sizeimage};
    }
    const v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    return {pix.width,
            pix.height,
            pix.pixelformat,
            pix.field,
            pix.num_planes,
            pix.plane_fmt[0].bytesperline,
            pix.plane_fmt[0].sizeimage};
}

/// Strides and sizes are 0: the driver's choice.
v4l2_format request_for(const V4l2Device& device, const Image& image) {
    v4l2_format format{};
    format.type = device.buffer_type();
    if (device.multi_planar()) {
        format.fmt.pix_mp.width = image.width;
        format.fmt.pix_mp.height = image.height;
        format.fmt.pix_mp.pixelformat = image.fourcc;
        format.fmt.pix_mp.field = V4L2_FIELD_NONE;
        format.fmt.pix_mp.num_planes = 1;
    } else {
        format.fmt.pix.width = image.width;
        format.fmt.pix.height = image.height;
        format.fmt.pix.pixelformat = image.fourcc;
        format.fmt.pix.field = V4L2_FIELD_NONE;
    }
    return format;
}

class FormatSetter {
  public:
    FormatSetter(const V4l2Device& device, const CameraSettings& settings)
        : device_(device), settings_(settings) {}

    V4l2Format set() {
        set_input();
        Image wanted = current();
        choose_format(wanted);
        wanted.width = number("Width", wanted.width, 1);
        wanted.height = number("Height", wanted.height, 1);
        set_region(wanted);
        set_image(wanted);
        read_region();
        set_rate();
        return result_;
    }

  private:
    [[noreturn]] void refuse(std::string_view name, std::string_view why) const {
        throw InputError(device_.address(), fmt::format("{}: {}", name, why));
    }

    [[nodiscard]] std::uint32_t number(std::string_view name, std::uint32_t otherwise,
                                       int min) const {
        const std::string* const text = value_of(settings_, name);
        if (text == nullptr) return otherwise;
        const auto value = integer_setting(*text);
        if (!value || *value < min || *value > kMaxFrameSide)
            refuse(name, fmt::format("\"{}\" is not a whole number from {} to {}", *text, min,
                                     kMaxFrameSide));
        return static_cast<std::uint32_t>(*value);
    }

    void set_input() {
        if (value_of(settings_, "Input") != nullptr) {
            auto input = static_cast<int>(number("Input", 0, 0));
            if (device_.call(VIDIOC_S_INPUT, &input) != 0)
                refuse("Input", fmt::format("the device has no input {}", input));
        }
        int input = 0;
        if (device_.call(VIDIOC_G_INPUT, &input) == 0)
            result_.facts["input"] = std::to_string(input);
    }

    [[nodiscard]] Image current() const {
        v4l2_format format{};
        format.type = device_.buffer_type();
        device_.demand(VIDIOC_G_FMT, &format, "read its format");
        return image_of(format, device_.multi_planar());
    }

    void choose_format(Image& wanted) {
        if (const std::string* const name = value_of(settings_, "PixelFormat")) {
            format_ = pixel_format_named(*name);
            if (format_ == nullptr || format_->v4l2 == 0)
                refuse("PixelFormat",
                       fmt::format("\"{}\" is not a format of V4L2 that is read here; {}", *name,
                                   offer()));
            wanted.fourcc = format_->v4l2;
        } else {
            format_ = pixel_format_of_v4l2(wanted.fourcc);
            if (format_ == nullptr)
                refuse("PixelFormat",
                       fmt::format("the device is set to {}, which is not read here; {}",
                                   fourcc_text(wanted.fourcc), offer()));
        }
    }

    [[nodiscard]] std::string offer() const {
        const auto names = v4l2_format_names(device_);
        if (names.empty()) return "it has none that is";
        return "it has " + joined(names);
    }

    /// The part of the sensor, where the driver lets us choose one. Done first: a format smaller
    /// than the region would be scaled.
    void set_region(const Image& wanted) {
        const auto given = [this](const char* name) {
            return value_of(settings_, name) != nullptr;
        };
        const bool asked = given("OffsetX") || given("OffsetY");
        if (!asked && !given("Width") && !given("Height")) return;
        v4l2_selection region{};
        region.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;  // selections know this type alone
        region.target = V4L2_SEL_TGT_CROP;
        const bool known = device_.call(VIDIOC_G_SELECTION, &region) == 0;
        const auto left = static_cast<int>(number("OffsetX", 0, 0));
        const auto top = static_cast<int>(number("OffsetY", 0, 0));
        if (!known && (left != 0 || top != 0))
            refuse("OffsetX, OffsetY", "the device cannot choose a region of its sensor");
        if (!known) return;
        region.r = {asked ? left : region.r.left, asked ? top : region.r.top, wanted.width,
                    wanted.height};
        const int error = device_.call(VIDIOC_S_SELECTION, &region);
        if (asked && (error != 0 || region.r.left != left || region.r.top != top))
            refuse("OffsetX, OffsetY",
                   fmt::format("the device does not put {} x {} pixels at ({}, {}); it offers {} x "
                               "{} at ({}, {})",
                               wanted.width, wanted.height, left, top, region.r.width,
                               region.r.height, region.r.left, region.r.top));
    }

    void set_image(const Image& wanted) {
        v4l2_format request = request_for(device_, wanted);
        device_.demand(VIDIOC_S_FMT, &request, fmt::format("set its format to {}", format_->name));
        const Image got = image_of(request, device_.multi_planar());
        if (got.fourcc != wanted.fourcc)
            refuse("PixelFormat", fmt::format("the device would send {} instead of {}; {}",
                                              fourcc_text(got.fourcc), format_->name, offer()));
        if (got.width != wanted.width || got.height != wanted.height)
            refuse("Width, Height",
                   fmt::format("the device would send {} x {} pixels instead of "
                               "{} x {}",
                               got.width, got.height, wanted.width, wanted.height));
        if (got.field != V4L2_FIELD_NONE && got.field != V4L2_FIELD_ANY)
            refuse("Input", "the device sends interlaced fields; choose a progressive input");
        if (got.planes > 1)
            refuse(
                "PixelFormat",
                fmt::format("the device sends {} in {} memory planes, of which one is read here; "
                            "{}",
                            format_->name, got.planes, offer()));
        check(got);
    }

    void check(const Image& got) {
        FrameLayout& layout = result_.layout;
        layout.format = format_;
        if (got.width == 0 || got.height == 0 || got.width > kMaxFrameSide ||
            got.height > kMaxFrameSide)
            throw DeviceError(
                device_.address(),
                fmt::format("the driver answers with {} x {} pixels", got.width, got.height));
        layout.width = static_cast<int>(got.width);
        layout.height = static_cast<int>(got.height);
        const std::size_t row_bytes = format_->row_bytes(layout.width);
        layout.stride_bytes = got.stride_bytes == 0 ? row_bytes : got.stride_bytes;
        result_.buffer_bytes = got.buffer_bytes;
        if (layout.stride_bytes < row_bytes || got.buffer_bytes < layout.payload_bytes())
            throw DeviceError(
                device_.address(),
                fmt::format(
                    "the driver answers with rows of {} bytes and frames of {}, too few for "
                    "{} x {} pixels of {}",
                    got.stride_bytes, got.buffer_bytes, got.width, got.height, format_->name));
    }

    void read_region() {
        v4l2_selection region{};
        region.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
        region.target = V4L2_SEL_TGT_CROP;
        if (device_.call(VIDIOC_G_SELECTION, &region) != 0) return;
        FrameLayout& layout = result_.layout;
        result_.facts["crop"] = fmt::format("{}x{}+{}+{}", region.r.width, region.r.height,
                                            region.r.left, region.r.top);
        layout.offset_x = std::max(0, region.r.left);
        layout.offset_y = std::max(0, region.r.top);
    }

    void set_rate() {
        v4l2_streamparm rate{};
        rate.type = device_.buffer_type();
        v4l2_fract& period = rate.parm.capture.timeperframe;
        if (const std::string* const text = value_of(settings_, "AcquisitionFrameRate")) {
            const auto wanted = number_setting(*text);
            if (!wanted || !(*wanted >= 0.001 && *wanted <= 1e6))
                refuse("AcquisitionFrameRate",
                       fmt::format("\"{}\" is not a number from 0.001 to 1e6", *text));
            period = {1000, static_cast<__u32>(std::lround(*wanted * 1000))};
            if (device_.call(VIDIOC_S_PARM, &rate) != 0)
                refuse("AcquisitionFrameRate", "the device does not let itself be told a rate");
            read_rate(rate);
            // Periods are coarse: UVC counts 100 ns, others whole lines.
            if (!(std::abs(result_.frames_hz / *wanted - 1) < 0.01))
                refuse("AcquisitionFrameRate",
                       fmt::format("the device would send {:.6g} frames/s instead of {}",
                                   result_.frames_hz, *text));
            return;
        }
        if (device_.call(VIDIOC_G_PARM, &rate) == 0) read_rate(rate);
    }

    void read_rate(const v4l2_streamparm& rate) {
        const v4l2_fract& period = rate.parm.capture.timeperframe;
        if (period.numerator != 0)
            result_.frames_hz = static_cast<double>(period.denominator) / period.numerator;
    }

    const V4l2Device& device_;
    const CameraSettings& settings_;
    const PixelFormat* format_ = nullptr;
    V4l2Format result_;
};

}  // namespace

V4l2Format set_v4l2_format(const V4l2Device& device, const CameraSettings& settings) {
    return FormatSetter(device, settings).set();
}

bool is_v4l2_format_setting(const std::string& name) {
    return std::find(kFormatSettings.begin(), kFormatSettings.end(), name) != kFormatSettings.end();
}

std::vector<std::string> v4l2_format_names(const V4l2Device& device) {
    constexpr std::uint32_t kMaxFormats = 1000;  // a driver that never ends its list
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < kMaxFormats; ++i) {
        v4l2_fmtdesc entry{};
        entry.index = i;
        entry.type = device.buffer_type();
        if (device.call(VIDIOC_ENUM_FMT, &entry) != 0) break;
        if (const PixelFormat* const format = pixel_format_of_v4l2(entry.pixelformat))
            names.emplace_back(format->name);
    }
    return names;
}

}  // namespace stipple
