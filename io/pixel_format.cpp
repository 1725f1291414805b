#include "io/pixel_format.h"

#include <algorithm>
#include <array>

namespace stipple {
namespace {

constexpr std::uint32_t fourcc(const char* text) {
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

/// Formats of one depth and packing, in the order of kBayerFilters.
struct BayerRow {
    std::string_view depth;             ///< the end of the name
    std::array<std::uint32_t, 4> pfnc;  ///< 0: none
    std::array<const char*, 4> fourcc;  ///< null: none
    int stored_bits;
    int significant_bits;
    Packing packing;
};

struct BayerFilter {
    std::string_view name;
    ColourFilter filter;
};

constexpr std::array kBayerFilters{
    BayerFilter{"BayerRG", ColourFilter::kRggb}, BayerFilter{"BayerGR", ColourFilter::kGrbg},
    BayerFilter{"BayerGB", ColourFilter::kGbrg}, BayerFilter{"BayerBG", ColourFilter::kBggr}};

constexpr std::array kBayerRows{
    BayerRow{"8",
             {0x01080009, 0x01080008, 0x0108000A, 0x0108000B},
             {"RGGB", "GRBG", "GBRG", "BA81"},
             8,
             8,
             Packing::kBytes},
    BayerRow{"10",
             {0x0110000D, 0x0110000C, 0x0110000E, 0x0110000F},
             {"RG10", "BA10", "GB10", "BG10"},
             16,
             10,
             Packing::kBytes},
    BayerRow{"12",
             {0x01100011, 0x01100010, 0x01100012, 0x01100013},
             {"RG12", "BA12", "GB12", "BG12"},
             16,
             12,
             Packing::kBytes},
    BayerRow{"14",
             {0x0110010A, 0x01100109, 0x0110010B, 0x0110010C},
             {"RG14", "GR14", "GB14", "BG14"},
             16,
             14,
             Packing::kBytes},
    BayerRow{"16",
             {0x0110002F, 0x0110002E, 0x01100030, 0x01100031},
             {"RG16", "GR16", "GB16", "BYR2"},
             16,
             16,
             Packing::kBytes},
    BayerRow{
        "10p", {0x010A0058, 0x010A0056, 0x010A0054, 0x010A0052}, {}, 10, 10, Packing::kLsbPacked},
    BayerRow{
        "12p", {0x010C0059, 0x010C0057, 0x010C0055, 0x010C0053}, {}, 12, 12, Packing::kLsbPacked},
    BayerRow{
        "14p", {0x010E0106, 0x010E0105, 0x010E0107, 0x010E0108}, {}, 14, 14, Packing::kLsbPacked},
    BayerRow{"10Packed",
             {0x010C0027, 0x010C0026, 0x010C0028, 0x010C0029},
             {},
             12,
             10,
             Packing::kGigEVisionPacked},
    BayerRow{"12Packed",
             {0x010C002B, 0x010C002A, 0x010C002C, 0x010C002D},
             {},
             12,
             12,
             Packing::kGigEVisionPacked},
    BayerRow{"10MIPI", {}, {"pRAA", "pgAA", "pGAA", "pBAA"}, 10, 10, Packing::kMipiPacked},
    BayerRow{"12MIPI", {}, {"pRCC", "pgCC", "pGCC", "pBCC"}, 12, 12, Packing::kMipiPacked},
    BayerRow{"14MIPI", {}, {"pREE", "pgEE", "pGEE", "pBEE"}, 14, 14, Packing::kMipiPacked},
};
constexpr std::size_t kBayerFormats = kBayerFilters.size() * kBayerRows.size();

/// "BayerRG10p" and the like.
constexpr auto kBayerNames = [] {
    std::array<std::array<char, 16>, kBayerFormats> names{};
    auto* name = names.begin();
    for (const BayerFilter& filter : kBayerFilters)
        for (const BayerRow& row : kBayerRows) {
            auto* const end = std::copy(filter.name.begin(), filter.name.end(), name->begin());
            std::copy(row.depth.begin(), row.depth.end(), end);
            ++name;
        }
    return names;
}();

constexpr auto kBayer = [] {
    std::array<PixelFormat, kBayerFormats> formats;
    for (std::size_t filter = 0; filter < kBayerFilters.size(); ++filter)
        for (std::size_t i = 0; i < kBayerRows.size(); ++i) {
            const BayerRow& row = kBayerRows[i];
            const std::size_t at = filter * kBayerRows.size() + i;
            const char* const code = row.fourcc[filter];
            formats[at] = {kBayerNames[at].data(),
                           row.pfnc[filter],
                           code == nullptr ? 0 : fourcc(code),
                           row.stored_bits,
                           row.significant_bits,
                           row.packing,
                           kBayerFilters[filter].filter};
        }
    return formats;
}();

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

constexpr std::array kFormats = joined_tables(kMono, kBayer, kColour);

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
