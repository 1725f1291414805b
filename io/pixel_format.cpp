#include "io/pixel_format.h"

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

constexpr std::uint32_t kBigEndian = 1U << 31U;  // linux/videodev2.h, v4l2_fourcc_be

// Codes: GenICam PFNC 2.x (32-bit values of the standard's header), linux/videodev2.h.
constexpr std::array kMono{
    PixelFormat{"Mono8", 0x01080001, fourcc("GREY"), 8, 8},
    PixelFormat{"Mono10", 0x01100003, fourcc("Y10 "), 16, 10},
    PixelFormat{"Mono12", 0x01100005, fourcc("Y12 "), 16, 12},
    PixelFormat{"Mono14", 0x01100025, fourcc("Y14 "), 16, 14},
    PixelFormat{"Mono16", 0x01100007, fourcc("Y16 "), 16, 16},
    PixelFormat{"Mono16BE", 0, fourcc("Y16 ") | kBigEndian, 16, 16, Packing::kBytesBigEndian},
    PixelFormat{"Mono10p", 0x010A0046, 0, 10, 10, Packing::kLsbPacked},
    PixelFormat{"Mono12p", 0x010C0047, 0, 12, 12, Packing::kLsbPacked},
    PixelFormat{"Mono14p", 0x010E0104, 0, 14, 14, Packing::kLsbPacked},
    PixelFormat{"Mono10Packed", 0x010C0004, 0, 12, 10, Packing::kGigEVisionPacked},
    PixelFormat{"Mono12Packed", 0x010C0006, 0, 12, 12, Packing::kGigEVisionPacked},
    PixelFormat{"Mono10MIPI", 0, fourcc("Y10P"), 10, 10, Packing::kMipiPacked},
};

constexpr std::array kBayerRg{
    PixelFormat{"BayerRG8", 0x01080009, fourcc("RGGB"), 8, 8, Packing::kBytes, ColourFilter::kRggb},
    PixelFormat{"BayerRG10", 0x0110000D, fourcc("RG10"), 16, 10, Packing::kBytes,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG12", 0x01100011, fourcc("RG12"), 16, 12, Packing::kBytes,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG14", 0x0110010A, fourcc("RG14"), 16, 14, Packing::kBytes,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG16", 0x0110002F, fourcc("RG16"), 16, 16, Packing::kBytes,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG10p", 0x010A0058, 0, 10, 10, Packing::kLsbPacked, ColourFilter::kRggb},
    PixelFormat{"BayerRG12p", 0x010C0059, 0, 12, 12, Packing::kLsbPacked, ColourFilter::kRggb},
    PixelFormat{"BayerRG14p", 0x010E0106, 0, 14, 14, Packing::kLsbPacked, ColourFilter::kRggb},
    PixelFormat{"BayerRG10Packed", 0x010C0027, 0, 12, 10, Packing::kGigEVisionPacked,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG12Packed", 0x010C002B, 0, 12, 12, Packing::kGigEVisionPacked,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG10MIPI", 0, fourcc("pRAA"), 10, 10, Packing::kMipiPacked,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG12MIPI", 0, fourcc("pRCC"), 12, 12, Packing::kMipiPacked,
                ColourFilter::kRggb},
    PixelFormat{"BayerRG14MIPI", 0, fourcc("pREE"), 14, 14, Packing::kMipiPacked,
                ColourFilter::kRggb},
};

constexpr std::array kBayerGr{
    PixelFormat{"BayerGR8", 0x01080008, fourcc("GRBG"), 8, 8, Packing::kBytes, ColourFilter::kGrbg},
    PixelFormat{"BayerGR10", 0x0110000C, fourcc("BA10"), 16, 10, Packing::kBytes,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR12", 0x01100010, fourcc("BA12"), 16, 12, Packing::kBytes,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR14", 0x01100109, fourcc("GR14"), 16, 14, Packing::kBytes,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR16", 0x0110002E, fourcc("GR16"), 16, 16, Packing::kBytes,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR10p", 0x010A0056, 0, 10, 10, Packing::kLsbPacked, ColourFilter::kGrbg},
    PixelFormat{"BayerGR12p", 0x010C0057, 0, 12, 12, Packing::kLsbPacked, ColourFilter::kGrbg},
    PixelFormat{"BayerGR14p", 0x010E0105, 0, 14, 14, Packing::kLsbPacked, ColourFilter::kGrbg},
    PixelFormat{"BayerGR10Packed", 0x010C0026, 0, 12, 10, Packing::kGigEVisionPacked,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR12Packed", 0x010C002A, 0, 12, 12, Packing::kGigEVisionPacked,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR10MIPI", 0, fourcc("pgAA"), 10, 10, Packing::kMipiPacked,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR12MIPI", 0, fourcc("pgCC"), 12, 12, Packing::kMipiPacked,
                ColourFilter::kGrbg},
    PixelFormat{"BayerGR14MIPI", 0, fourcc("pgEE"), 14, 14, Packing::kMipiPacked,
                ColourFilter::kGrbg},
};

constexpr std::array kBayerGb{
    PixelFormat{"BayerGB8", 0x0108000A, fourcc("GBRG"), 8, 8, Packing::kBytes, ColourFilter::kGbrg},
    PixelFormat{"BayerGB10", 0x0110000E, fourcc("GB10"), 16, 10, Packing::kBytes,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB12", 0x01100012, fourcc("GB12"), 16, 12, Packing::kBytes,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB14", 0x0110010B, fourcc("GB14"), 16, 14, Packing::kBytes,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB16", 0x01100030, fourcc("GB16"), 16, 16, Packing::kBytes,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB10p", 0x010A0054, 0, 10, 10, Packing::kLsbPacked, ColourFilter::kGbrg},
    PixelFormat{"BayerGB12p", 0x010C0055, 0, 12, 12, Packing::kLsbPacked, ColourFilter::kGbrg},
    PixelFormat{"BayerGB14p", 0x010E0107, 0, 14, 14, Packing::kLsbPacked, ColourFilter::kGbrg},
    PixelFormat{"BayerGB10Packed", 0x010C0028, 0, 12, 10, Packing::kGigEVisionPacked,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB12Packed", 0x010C002C, 0, 12, 12, Packing::kGigEVisionPacked,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB10MIPI", 0, fourcc("pGAA"), 10, 10, Packing::kMipiPacked,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB12MIPI", 0, fourcc("pGCC"), 12, 12, Packing::kMipiPacked,
                ColourFilter::kGbrg},
    PixelFormat{"BayerGB14MIPI", 0, fourcc("pGEE"), 14, 14, Packing::kMipiPacked,
                ColourFilter::kGbrg},
};

constexpr std::array kBayerBg{
    PixelFormat{"BayerBG8", 0x0108000B, fourcc("BA81"), 8, 8, Packing::kBytes, ColourFilter::kBggr},
    PixelFormat{"BayerBG10", 0x0110000F, fourcc("BG10"), 16, 10, Packing::kBytes,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG12", 0x01100013, fourcc("BG12"), 16, 12, Packing::kBytes,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG14", 0x0110010C, fourcc("BG14"), 16, 14, Packing::kBytes,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG16", 0x01100031, fourcc("BYR2"), 16, 16, Packing::kBytes,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG10p", 0x010A0052, 0, 10, 10, Packing::kLsbPacked, ColourFilter::kBggr},
    PixelFormat{"BayerBG12p", 0x010C0053, 0, 12, 12, Packing::kLsbPacked, ColourFilter::kBggr},
    PixelFormat{"BayerBG14p", 0x010E0108, 0, 14, 14, Packing::kLsbPacked, ColourFilter::kBggr},
    PixelFormat{"BayerBG10Packed", 0x010C0029, 0, 12, 10, Packing::kGigEVisionPacked,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG12Packed", 0x010C002D, 0, 12, 12, Packing::kGigEVisionPacked,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG10MIPI", 0, fourcc("pBAA"), 10, 10, Packing::kMipiPacked,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG12MIPI", 0, fourcc("pBCC"), 12, 12, Packing::kMipiPacked,
                ColourFilter::kBggr},
    PixelFormat{"BayerBG14MIPI", 0, fourcc("pBEE"), 14, 14, Packing::kMipiPacked,
                ColourFilter::kBggr},
};

constexpr std::array kColour{
    PixelFormat{"RGB8", 0x02180014, fourcc("RGB3"), 24, 8, Packing::kBytes, ColourFilter::kNone, 3},
};

template <std::size_t... kSizes>
constexpr auto joined_tables(const std::array<PixelFormat, kSizes>&... tables) {
    std::array<PixelFormat, (kSizes + ...)> all;
    auto* next = all.begin();
    ((next = std::copy(tables.begin(), tables.end(), next)), ...);
    return all;
}

constexpr std::array kFormats =
    joined_tables(kMono, kBayerRg, kBayerGr, kBayerGb, kBayerBg, kColour);

template <typename Match>
const PixelFormat* find_format(Match match) {
    const auto* const found = std::find_if(kFormats.begin(), kFormats.end(), match);
    return found == kFormats.end() ? nullptr : found;
}

}  // namespace

std::size_t PixelFormat::row_bytes(int width) const {
    auto pixels = static_cast<std::size_t>(width);
    if (packing == Packing::kMipiPacked) {
        const std::size_t group = significant_bits == 12 ? 2 : 4;
        pixels = (pixels + group - 1) / group * group;
    }
    return (pixels * static_cast<std::size_t>(bits_per_pixel) + 7) / 8;
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
