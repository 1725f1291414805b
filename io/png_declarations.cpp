#include "io/png_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>

#include "core/error.h"
#include "io/video_planes.h"

namespace stipple {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Chunks = std::map<std::string, Bytes, std::less<>>;

/// `count` bytes, the highest first. Precondition: that many bytes.
std::uint32_t big_endian(Bytes bytes, std::size_t count = 4) {
    std::uint32_t value = 0;
    for (const std::uint8_t byte : bytes.first(count)) value = value << 8U | byte;
    return value;
}

/// The first chunk of each kind.
Chunks chunks_of(Bytes file) {
    constexpr std::size_t kSignatureBytes = 8;
    constexpr std::size_t kFrameBytes = 12;  // length, kind and CRC
    Chunks chunks;
    for (Bytes rest = file.subspan(kSignatureBytes); rest.size() >= kFrameBytes;) {
        const std::size_t length = big_endian(rest);
        if (length > rest.size() - kFrameBytes) break;
        const Bytes kind = rest.subspan(4, 4);
        chunks.emplace(std::string(kind.begin(), kind.end()), rest.subspan(8, length));
        rest = rest.subspan(kFrameBytes + length);
    }
    return chunks;
}

/// Of a chunk with at least `bytes` bytes.
std::optional<Bytes> find(const Chunks& chunks, std::string_view kind, std::size_t bytes) {
    const auto found = chunks.find(kind);
    if (found == chunks.end() || found->second.size() < bytes) return {};
    return found->second;
}

void declare(SourceInfo& traits, std::optional<Transfer> transfer, std::string curve) {
    traits.gamma_coded = transfer != Transfer::kLinear;
    traits.declared = transfer;
    traits.curve = std::move(curve);
}

void add_code_points(Bytes points, bool colour, const std::string& where, SourceInfo& traits) {
    constexpr int kBt709 = 1;
    constexpr int kBt2020 = 9;
    if (points[3] != 1)
        throw InputError(where, "declares numbers of limited range (cICP), which are not read");
    const auto transfer = transfer_of_code(points[1]);
    declare(traits, transfer,
            transfer ? std::string(name_of(*transfer)) : fmt::format("{} of H.273", points[1]));
    traits.bt2020 = points[0] == kBt2020;
    if (colour && points[0] != kBt709)
        traits.primaries = traits.bt2020 ? "bt2020" : fmt::format("{} of H.273", points[0]);
}

void add_profile(Bytes profile, bool colour, SourceInfo& traits) {
    const std::string name(profile.begin(), std::ranges::find(profile, '\0'));
    std::string lower = name;
    std::ranges::transform(lower, lower.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    if (lower.find("srgb") != std::string::npos) return declare(traits, Transfer::kSrgb, "srgb");
    std::ranges::replace_if(
        lower, [](char c) { return c < ' ' || c > '~'; }, '?');
    declare(traits, std::nullopt, fmt::format("of the profile \"{}\"", lower.substr(0, 79)));
    if (colour) traits.primaries = traits.curve;
}

void add_gamma(Bytes gamma, SourceInfo& traits) {
    constexpr std::uint32_t kLinear = 100'000;
    constexpr std::uint32_t kMinOfSrgb = 44'000;  // 45455, rounded in some way
    constexpr std::uint32_t kMaxOfSrgb = 47'000;
    const std::uint32_t power = big_endian(gamma);
    if (power == kLinear) return declare(traits, Transfer::kLinear, "linear");
    const bool of_srgb = power >= kMinOfSrgb && power <= kMaxOfSrgb;
    declare(traits, of_srgb ? std::optional(Transfer::kSrgb) : std::nullopt,
            fmt::format("power {:.4g}", power / 1e5));
}

/// White, red, green and blue of Rec. 709 as the chunk has them; x before y.
bool is_rec_709(Bytes chromaticities) {
    constexpr std::array<int, 8> kRec709{31270, 32900, 64000, 33000, 30000, 60000, 15000, 6000};
    constexpr int kRounding = 500;
    for (std::size_t i = 0; i < kRec709.size(); ++i) {
        const auto value = static_cast<int>(big_endian(chromaticities.subspan(4 * i)));
        if (std::abs(std::int64_t{value} - kRec709[i]) > kRounding) return false;
    }
    return true;
}

/// Of an Exif block, a TIFF directory; 1 is upright.
std::uint32_t orientation_of(Bytes exif) {
    constexpr std::uint32_t kOrientation = 274;
    constexpr std::size_t kEntryBytes = 12;
    const bool little = exif[0] == 'I';
    const auto number = [&](std::size_t at, std::size_t count) {
        std::array<std::uint8_t, 4> bytes{};
        std::copy_n(exif.begin() + static_cast<std::ptrdiff_t>(at), count, bytes.begin());
        if (little) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
        return big_endian(bytes, count);
    };
    const std::size_t directory = number(4, 4);
    if (directory > exif.size() - 2) return 1;
    const std::uint32_t entries = number(directory, 2);
    for (std::size_t i = 0, at = directory + 2; i < entries; ++i, at += kEntryBytes) {
        if (exif.size() < kEntryBytes || at > exif.size() - kEntryBytes) break;
        if (number(at, 2) == kOrientation) return number(at + 8, 2);
    }
    return 1;
}

void add_warnings(const Chunks& chunks, SourceInfo& traits) {
    if (const auto pixel = find(chunks, "pHYs", 9)) {
        const double x = big_endian(*pixel);
        const double y = big_endian(pixel->subspan(4));
        if (x > 0 && y > 0 && x != y)
            traits.warnings.push_back(
                fmt::format("declares pixels {:.4g} times as wide as high; "
                            "they are taken for square ones",
                            y / x));
    }
    if (const auto exif = find(chunks, "eXIf", 8)) {
        const std::uint32_t orientation = orientation_of(*exif);
        if (orientation > 1 && orientation <= 8)
            traits.warnings.push_back(fmt::format(
                "is to be shown turned or mirrored (orientation {}); it is read as stored",
                orientation));
    }
}

}  // namespace

void add_png_declarations(Bytes file, bool colour, const std::string& where, SourceInfo& traits) {
    const Chunks chunks = chunks_of(file);
    if (const auto animation = find(chunks, "acTL", 8); animation && big_endian(*animation) > 1)
        throw InputError(where, fmt::format("is an animation of {} frames; make images of them "
                                            "first: ffmpeg -i FILE %04d.png",
                                            big_endian(*animation)));
    const auto primaries = find(chunks, "cHRM", 32);
    if (const auto points = find(chunks, "cICP", 4))
        add_code_points(*points, colour, where, traits);
    else if (const auto profile = find(chunks, "iCCP", 1))
        add_profile(*profile, colour, traits);
    else if (find(chunks, "sRGB", 1))
        declare(traits, Transfer::kSrgb, "srgb");
    else {
        if (const auto gamma = find(chunks, "gAMA", 4)) add_gamma(*gamma, traits);
        if (primaries && colour && !is_rec_709(*primaries)) traits.primaries = "of its chunk cHRM";
    }
    if (const auto bits = find(chunks, "sBIT", colour ? 3 : 1))
        traits.bits = std::min<int>(traits.bits, *std::max_element(bits->begin(), bits->end()));
    add_warnings(chunks, traits);
}

}  // namespace stipple
