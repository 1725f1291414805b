#include "io/dng_file.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "core/error.h"
#include "core/light.h"
#include "core/text.h"

namespace stipple {
namespace {

constexpr std::uint32_t kFrameRateTag = 51044;  // CinemaDNG 1.1
constexpr std::uint32_t kSubTileBlockSize = 50974;
constexpr std::uint32_t kRowInterleave = 50975;
constexpr std::uint32_t kColumnInterleave = 52547;
constexpr std::uint16_t kLinearRaw = 34892;  // DNG 1.4

template <typename Number>
std::vector<Number> numbers(tiff* file, std::uint32_t tag) {
    std::uint16_t count = 0;
    const Number* values = nullptr;
    if (TIFFGetField(file, tag, &count, &values) != 1 || values == nullptr) return {};
    return {values, values + count};
}

template <typename Number>
Number number_or(tiff* file, std::uint32_t tag, Number otherwise) {
    Number value = otherwise;
    return TIFFGetFieldDefaulted(file, tag, &value) == 1 ? value : otherwise;
}

/// Numbers of a tag that libtiff does not know, and then describes by what the file says; empty if
/// they are of another type.
template <typename Number>
std::span<const Number> unknown_numbers(tiff* file, std::uint32_t tag, TIFFDataType type) {
    const TIFFField* const field = TIFFFindField(file, tag, TIFF_ANY);
    if (field == nullptr || TIFFFieldDataType(field) != type || TIFFFieldPassCount(field) == 0 ||
        TIFFFieldReadCount(field) != TIFF_VARIABLE2)
        return {};
    std::uint32_t count = 0;
    const Number* values = nullptr;
    if (TIFFGetField(file, tag, &count, &values) != 1 || values == nullptr) return {};
    return {values, count};
}

/// Whether such numbers are there and not all 1.
bool is_not_one(tiff* file, std::uint32_t tag) {
    const auto other = [](auto number) { return number != 1; };
    return std::ranges::any_of(unknown_numbers<std::uint16_t>(file, tag, TIFF_SHORT), other) ||
           std::ranges::any_of(unknown_numbers<std::uint32_t>(file, tag, TIFF_LONG), other);
}

/// Of a tag that libtiff may not know, and then describes by what the file says: a positive number.
std::optional<double> rational(tiff* file, std::uint32_t tag) {
    const TIFFField* const field = TIFFFindField(file, tag, TIFF_ANY);
    if (field == nullptr) return {};
    const int type = TIFFFieldDataType(field);  // of an unknown tag any number: none of the enum
    if (type != TIFF_RATIONAL && type != TIFF_SRATIONAL) return {};
    const bool is_double = TIFFFieldSetGetSize(field) == sizeof(double);
    double value = 0;
    if (TIFFFieldPassCount(field) != 0) {
        std::uint32_t count32 = 0;
        std::uint16_t count16 = 0;
        const void* values = nullptr;
        const bool is_long = TIFFFieldReadCount(field) == TIFF_VARIABLE2;
        const int found = is_long ? TIFFGetField(file, tag, &count32, &values)
                                  : TIFFGetField(file, tag, &count16, &values);
        if (found != 1 || values == nullptr || count32 + count16 == 0) return {};
        value = is_double ? *static_cast<const double*>(values)
                          : static_cast<double>(*static_cast<const float*>(values));
    } else if (is_double) {
        if (TIFFGetField(file, tag, &value) != 1) return {};
    } else {
        float single = 0;
        if (TIFFGetField(file, tag, &single) != 1) return {};
        value = static_cast<double>(single);
    }
    return std::isfinite(value) && value > 0 ? std::optional(value) : std::nullopt;
}

bool is_raw(tiff* file) {
    const auto photometric = number_or<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    const bool is_main = number_or<std::uint32_t>(file, TIFFTAG_SUBFILETYPE, 0) == 0;
    return is_main && (photometric == PHOTOMETRIC_CFA || photometric == kLinearRaw ||
                       photometric == PHOTOMETRIC_MINISBLACK);
}

/// Of the lists of opcodes, each once.
std::string opcode_names(tiff* file) {
    constexpr std::array<const char*, 14> kNames{"",
                                                 "WarpRectilinear",
                                                 "WarpFisheye",
                                                 "FixVignetteRadial",
                                                 "FixBadPixelsConstant",
                                                 "FixBadPixelsList",
                                                 "TrimBounds",
                                                 "MapTable",
                                                 "MapPolynomial",
                                                 "GainMap",
                                                 "DeltaPerRow",
                                                 "DeltaPerColumn",
                                                 "ScalePerRow",
                                                 "ScalePerColumn"};
    constexpr std::size_t kHeadBytes = 16;  // opcode, version, flags, bytes that follow
    std::vector<std::string> names;
    for (const std::uint32_t tag : {51008U, 51009U, 51022U}) {
        auto list = unknown_numbers<std::uint8_t>(file, tag, TIFF_UNDEFINED);
        const auto number = [&](std::size_t at) {
            std::uint32_t value = 0;
            for (const std::uint8_t byte : list.subspan(at, 4)) value = value << 8U | byte;
            return value;
        };
        if (list.size() < 4) continue;
        list = list.subspan(4);
        while (list.size() >= kHeadBytes) {
            const std::uint32_t code = number(0);
            names.push_back(code > 0 && code < kNames.size() ? kNames[code]
                                                             : fmt::format("opcode {}", code));
            list = list.subspan(kHeadBytes +
                                std::min<std::size_t>(number(12), list.size() - kHeadBytes));
        }
    }
    std::ranges::sort(names);
    names.erase(std::unique(names.begin(), names.end()), names.end());
    names.resize(std::min(names.size(), kNames.size()));
    return joined(names);
}

ColourFilter filter_of(tiff* file, const std::string& name) {
    constexpr std::array<std::pair<std::array<std::uint8_t, 4>, ColourFilter>, 4> kPatterns{
        {{{0, 1, 1, 2}, ColourFilter::kRggb},
         {{1, 0, 2, 1}, ColourFilter::kGrbg},
         {{1, 2, 0, 1}, ColourFilter::kGbrg},
         {{2, 1, 1, 0}, ColourFilter::kBggr}}};
    const std::uint16_t* dimensions = nullptr;
    const bool is_2_by_2 = TIFFGetField(file, TIFFTAG_CFAREPEATPATTERNDIM, &dimensions) == 1 &&
                           dimensions[0] == 2 && dimensions[1] == 2;
    const auto colours = numbers<std::uint8_t>(file, TIFFTAG_CFAPATTERN);
    for (const auto& [pattern, filter] : kPatterns)
        if (is_2_by_2 && std::ranges::equal(colours, pattern)) return filter;
    throw InputError(name, "has a colour filter array that is none of RGGB, GRBG, GBRG and BGGR");
}

}  // namespace

void find_raw(const TiffHandle& handle) {
    constexpr std::size_t kMaxDirectories = 16;
    if (is_raw(handle.get())) return;
    const auto offsets = numbers<std::uint64_t>(handle.get(), TIFFTAG_SUBIFD);
    for (std::size_t i = 0; i < std::min(offsets.size(), kMaxDirectories); ++i) {
        if (TIFFSetSubDirectory(handle.get(), offsets[i]) == 0) handle.fail(handle.name());
        if (is_raw(handle.get())) return;
    }
    throw InputError(handle.name(),
                     "holds no raw image, neither grey nor of a colour filter array");
}

DngPage::DngPage(tiff* file, const std::string& name)
    : rows(number_or<std::uint32_t>(file, TIFFTAG_IMAGELENGTH, 0)),
      cols(number_or<std::uint32_t>(file, TIFFTAG_IMAGEWIDTH, 0)),
      bits(number_or<std::uint16_t>(file, TIFFTAG_BITSPERSAMPLE, 1)),
      photometric(number_or<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, 0)),
      compression(number_or<std::uint16_t>(file, TIFFTAG_COMPRESSION, COMPRESSION_NONE)),
      area{.bottom = rows, .right = cols} {
    check_kind(file, name);
    static_cast<void>(checked_shape(rows, cols, 1, name));
    const std::uint32_t* active = nullptr;
    if (TIFFGetField(file, TIFFTAG_ACTIVEAREA, &active) == 1)
        area = {active[0], active[1], active[2], active[3]};
    if (area.top >= area.bottom || area.left >= area.right || area.bottom > rows ||
        area.right > cols)
        throw InputError(name, "has an active area outside the image; it is damaged");
    if (photometric == PHOTOMETRIC_CFA) filter = filter_of(file, name);
    read_levels(file, name);
}

void DngPage::check_kind(tiff* file, const std::string& name) const {
    const auto channels = number_or<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto kind = number_or<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const auto orientation =
        number_or<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (compression != COMPRESSION_NONE && compression != COMPRESSION_ADOBE_DEFLATE &&
        compression != COMPRESSION_JPEG)
        throw InputError(name,
                         fmt::format("is compressed (kind {}); save it uncompressed", compression));
    for (const std::uint32_t tag : {kSubTileBlockSize, kRowInterleave, kColumnInterleave})
        if (is_not_one(file, tag))
            throw InputError(name,
                             fmt::format("has rows or columns in another order (tag {})", tag));
    constexpr std::array<std::uint8_t, 3> kRedGreenBlue{0, 1, 2};
    const auto planes = numbers<std::uint8_t>(file, TIFFTAG_CFAPLANECOLOR);
    if (!planes.empty() && !std::ranges::equal(planes, kRedGreenBlue))
        throw InputError(name, "has a colour filter array of other colours than red, green, blue");
    if (channels != 1 || kind != SAMPLEFORMAT_UINT || bits < 8 || bits > 16)
        throw InputError(name, fmt::format("has {} samples of {} bits a pixel (format {}); one "
                                           "unsigned integer of 8 to 16 bits is read",
                                           channels, bits, kind));
    if (number_or<std::uint16_t>(file, TIFFTAG_CFALAYOUT, 1) != 1)
        throw InputError(name, "has a colour filter array whose rows or columns are staggered");
    if (orientation != ORIENTATION_TOPLEFT)
        throw InputError(name,
                         fmt::format("its rows do not run from the top left (orientation {}); "
                                     "save it upright",
                                     orientation));
}

void DngPage::read_levels(tiff* file, const std::string& name) {
    linear = numbers<std::uint16_t>(file, TIFFTAG_LINEARIZATIONTABLE);
    const std::uint16_t* repeat = nullptr;
    if (TIFFGetField(file, TIFFTAG_BLACKLEVELREPEATDIM, &repeat) == 1)
        std::tie(black_rows, black_cols) = std::pair(repeat[0], repeat[1]);
    black_dn = numbers<float>(file, TIFFTAG_BLACKLEVEL);
    if (black_dn.empty()) {
        black_rows = black_cols = 1;
        black_dn = {0};
    }
    const auto white = numbers<std::uint32_t>(file, TIFFTAG_WHITELEVEL);
    white_dn = white.empty() ? (1U << static_cast<unsigned>(bits)) - 1 : white[0];
    const auto deltas = [&](std::uint32_t tag, std::size_t count) {
        std::vector<float> values = numbers<float>(file, tag);
        if (!values.empty() && values.size() != count)
            throw InputError(name, "has black levels of rows or columns that do not suit its area");
        return values;
    };
    black_of_col = deltas(TIFFTAG_BLACKLEVELDELTAH, area.right - area.left);
    black_of_row = deltas(TIFFTAG_BLACKLEVELDELTAV, area.bottom - area.top);
    const auto max_of = [](const std::vector<float>& values) {
        return values.empty() ? 0.0F : std::ranges::max(values);
    };
    const float highest = max_of(black_of_row) + max_of(black_of_col);
    const auto is_level = [&](float black) {
        return black >= 0 && static_cast<double>(black + highest) < white_dn;
    };
    if (black_dn.size() != std::size_t{1} * black_rows * black_cols ||
        !std::ranges::all_of(black_dn, is_level))
        throw InputError(name, fmt::format("has black levels that do not suit its white level ({}) "
                                           "or their pattern",
                                           white_dn));
}

double DngPage::black_at(std::uint32_t row, std::uint32_t col) const {
    double black = static_cast<double>(
        black_dn[row % black_rows * std::size_t{black_cols} + col % black_cols]);
    if (!black_of_row.empty()) black += static_cast<double>(black_of_row[row]);
    if (!black_of_col.empty()) black += static_cast<double>(black_of_col[col]);
    return black;
}

bool DngPage::has_one_black() const {
    return black_of_row.empty() && black_of_col.empty() &&
           std::ranges::count(black_dn, black_dn.front()) == std::ssize(black_dn);
}

void add_dng_warnings(tiff* file, SourceInfo& traits) {
    const std::string opcodes = opcode_names(file);
    if (!opcodes.empty())
        traits.warnings.push_back(
            fmt::format("declares corrections that are not applied: {}", opcodes));
    const float* scale = nullptr;
    if (TIFFGetField(file, TIFFTAG_DEFAULTSCALE, &scale) == 1 && scale[0] != scale[1])
        traits.warnings.push_back(
            fmt::format("declares pixels {:.4g} times as wide as high; they "
                        "are taken for square ones",
                        static_cast<double>(scale[0] / scale[1])));
    if (numbers<float>(file, TIFFTAG_BLACKLEVEL).empty() &&
        !numbers<std::uint32_t>(file, TIFFTAG_MASKEDAREAS).empty())
        traits.warnings.emplace_back(
            "has masked areas, but declares no black level; it is taken to be 0");
}

void read_dng_camera(const TiffHandle& handle, SourceInfo& traits) {
    constexpr double kMicrosecondsPerSecond = 1e6;
    traits.frames_hz = rational(handle.get(), kFrameRateTag);
    auto exposure_s = rational(handle.get(), EXIFTAG_EXPOSURETIME);
    std::uint64_t exif = 0;
    if (!exposure_s && TIFFGetField(handle.get(), TIFFTAG_EXIFIFD, &exif) == 1) {
        if (TIFFReadEXIFDirectory(handle.get(), exif) != 0)
            exposure_s = rational(handle.get(), EXIFTAG_EXPOSURETIME);
        if (TIFFSetDirectory(handle.get(), 0) == 0) handle.fail(handle.name());
    }
    if (exposure_s) traits.exposure_us = *exposure_s * kMicrosecondsPerSecond;
}

}  // namespace stipple
