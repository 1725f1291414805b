#include "capture/pixel_format.h"

#include <algorithm>
#include <array>

namespace stipple {
namespace {

constexpr std::uint32_t fourcc(const char (&text)[5]) {
    std::uint32_t code = 0;
    for (int i = 3; i >= 0; --i)
        code = code << 8U | static_cast<std::uint32_t>(static_cast<unsigned char>(text[i]));
    return code;
}

// Codes: GenICam PFNC 2.x (32-bit values of the standard's header), linux/videodev2.h.
constexpr std::array kFormats{
    PixelFormat{"Mono8", 0x01080001, fourcc("GREY"), 8, 8},
    PixelFormat{"Mono16", 0x01100007, fourcc("Y16 "), 16, 16},
};

template <typename Match>
const PixelFormat* find_format(Match match) {
    const auto* const found = std::find_if(kFormats.begin(), kFormats.end(), match);
    return found == kFormats.end() ? nullptr : found;
}

}  // namespace

std::size_t PixelFormat::row_bytes(int width) const {
    return (static_cast<std::size_t>(width) * static_cast<std::size_t>(bits_per_pixel) + 7) / 8;
}

std::span<const PixelFormat> pixel_formats() {
    return kFormats;
}

const PixelFormat* pixel_format_named(std::string_view name) {
    return find_format([&](const PixelFormat& format) { return format.name == name; });
}

const PixelFormat* pixel_format_of_pfnc(std::uint32_t code) {
    return find_format([&](const PixelFormat& format) { return code != 0 && format.pfnc == code; });
}

const PixelFormat* pixel_format_of_v4l2(std::uint32_t code) {
    return find_format([&](const PixelFormat& format) { return code != 0 && format.v4l2 == code; });
}

}  // namespace stipple
