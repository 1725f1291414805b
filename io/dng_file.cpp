#include "io/dng_file.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/light.h"
#include "io/pixel_unpack.h"
#include "io/tiff_handle.h"

namespace stipple {
namespace {

constexpr std::uint32_t kFrameRateTag = 51044;  // CinemaDNG 1.1
constexpr std::uint16_t kLinearRaw = 34892;     // DNG 1.4

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

/// The rectangle of the pixels that see light.
struct Area {
    std::uint32_t top = 0;
    std::uint32_t left = 0;
    std::uint32_t bottom = 0;
    std::uint32_t right = 0;
};

/// What the directory of the raw image says.
struct RawPage {
    std::uint32_t rows = 0;
    std::uint32_t cols = 0;
    int bits = 0;
    std::uint16_t photometric = 0;
    std::uint16_t compression = 0;
    Area area;
    ColourFilter filter = ColourFilter::kNone;
    std::vector<std::uint16_t> linear;  ///< of each stored number; empty: itself
    std::uint16_t black_rows = 1;       ///< of the pattern of black levels, from the area's corner
    std::uint16_t black_cols = 1;
    std::vector<float> black_dn;
    double white_dn = 0;

    RawPage(tiff* file, const std::string& name);
    void read_levels(tiff* file, const std::string& name);
    void check_kind(tiff* file, const std::string& name) const;
};

bool is_raw(tiff* file) {
    const auto photometric = number_or<std::uint16_t>(file, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_RGB);
    const bool is_main = number_or<std::uint32_t>(file, TIFFTAG_SUBFILETYPE, 0) == 0;
    return is_main && (photometric == PHOTOMETRIC_CFA || photometric == kLinearRaw ||
                       photometric == PHOTOMETRIC_MINISBLACK);
}

/// Goes to the raw image, which is the first directory or one below it.
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

RawPage::RawPage(tiff* file, const std::string& name)
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

void RawPage::check_kind(tiff* file, const std::string& name) const {
    const auto channels = number_or<std::uint16_t>(file, TIFFTAG_SAMPLESPERPIXEL, 1);
    const auto kind = number_or<std::uint16_t>(file, TIFFTAG_SAMPLEFORMAT, SAMPLEFORMAT_UINT);
    const auto orientation =
        number_or<std::uint16_t>(file, TIFFTAG_ORIENTATION, ORIENTATION_TOPLEFT);
    if (compression != COMPRESSION_NONE && compression != COMPRESSION_ADOBE_DEFLATE)
        throw InputError(name,
                         fmt::format("is compressed (kind {}); save it uncompressed", compression));
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

void RawPage::read_levels(tiff* file, const std::string& name) {
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
    const auto is_level = [this](float black) {
        return black >= 0 && static_cast<double>(black) < white_dn;
    };
    if (black_dn.size() != std::size_t{1} * black_rows * black_cols ||
        !std::ranges::all_of(black_dn, is_level))
        throw InputError(name, fmt::format("has black levels that do not suit its white level ({}) "
                                           "or their pattern",
                                           white_dn));
    for (const int tag : {TIFFTAG_BLACKLEVELDELTAH, TIFFTAG_BLACKLEVELDELTAV})
        for (const float delta : numbers<float>(file, static_cast<std::uint32_t>(tag)))
            if (delta != 0)
                throw InputError(name, "has black levels of its own for each row or column");
}

/// The stored numbers, by row and column of the whole image.
class Samples {
  public:
    Samples(const TiffHandle& handle, const RawPage& page)
        : handle_(handle), page_(page), all_(std::size_t{page.rows} * page.cols) {
        format_.bits_per_pixel = format_.significant_bits = page.bits;
        // libtiff turns words of 16 bits into those of this machine.
        format_.packing = page.bits % 8 == 0 ? Packing::kBytes : Packing::kMsbPacked;
        TIFFIsTiled(handle.get()) != 0 ? read_tiles() : read_rows();
    }

    [[nodiscard]] std::uint16_t at(std::size_t row, std::size_t col) const {
        return all_[row * page_.cols + col];
    }

  private:
    void read_rows() {
        std::vector<std::uint8_t> row(static_cast<std::size_t>(TIFFScanlineSize64(handle_.get())));
        if (row.size() < format_.row_bytes(static_cast<int>(page_.cols)))
            handle_.fail(handle_.name());
        for (std::uint32_t y = 0; y < page_.rows; ++y) {
            if (TIFFReadScanline(handle_.get(), row.data(), y, 0) < 0) handle_.fail(handle_.name());
            unpack_row(format_, row,
                       std::span(all_).subspan(std::size_t{y} * page_.cols, page_.cols));
        }
    }
    void read_tiles();

    const TiffHandle& handle_;
    const RawPage& page_;
    PixelFormat format_;
    std::vector<std::uint16_t> all_;
};

void Samples::read_tiles() {
    const auto width = number_or<std::uint32_t>(handle_.get(), TIFFTAG_TILEWIDTH, 0);
    const auto height = number_or<std::uint32_t>(handle_.get(), TIFFTAG_TILELENGTH, 0);
    if (width < 1 || width > kMaxFrameSide || height < 1 || height > kMaxFrameSide)
        handle_.fail(handle_.name());
    const std::size_t row_bytes = format_.row_bytes(static_cast<int>(width));
    const std::uint64_t bytes = TIFFTileSize64(handle_.get());
    if (bytes < row_bytes * height) handle_.fail(handle_.name());
    std::vector<std::uint8_t> tile(bytes);
    std::vector<std::uint16_t> samples(width);
    for (std::uint32_t y = 0; y < page_.rows; y += height)
        for (std::uint32_t x = 0; x < page_.cols; x += width) {
            if (TIFFReadTile(handle_.get(), tile.data(), x, y, 0, 0) < 0)
                handle_.fail(handle_.name());
            for (std::uint32_t row = 0; row < std::min(height, page_.rows - y); ++row) {
                unpack_row(format_, std::span(tile).subspan(row * row_bytes, row_bytes), samples);
                std::copy_n(samples.begin(), std::min(width, page_.cols - x),
                            all_.begin() +
                                static_cast<std::ptrdiff_t>(std::size_t{y + row} * page_.cols + x));
            }
        }
}

void read_camera(const TiffHandle& handle, SourceTraits& traits) {
    constexpr double kMicrosecondsASecond = 1e6;
    traits.frames_hz = rational(handle.get(), kFrameRateTag);
    auto exposure_s = rational(handle.get(), EXIFTAG_EXPOSURETIME);
    std::uint64_t exif = 0;
    if (!exposure_s && TIFFGetField(handle.get(), TIFFTAG_EXIFIFD, &exif) == 1) {
        if (TIFFReadEXIFDirectory(handle.get(), exif) != 0)
            exposure_s = rational(handle.get(), EXIFTAG_EXPOSURETIME);
        if (TIFFSetDirectory(handle.get(), 0) == 0) handle.fail(handle.name());
    }
    if (exposure_s) traits.exposure_us = *exposure_s * kMicrosecondsASecond;
}

}  // namespace

void read_dng(const std::filesystem::path& file, Image& image) {
    const TiffHandle handle(file);
    image.traits = {};
    read_camera(handle, image.traits);
    find_raw(handle);
    const RawPage page(handle.get(), handle.name());
    const std::uint64_t stored =
        std::uint64_t{page.rows} *
        ((std::uint64_t{page.cols} * static_cast<unsigned>(page.bits) + 7) / 8);
    constexpr std::uint64_t kBytesAPixel = sizeof(std::uint16_t) + sizeof(float);
    handle.check_size(stored, kBytesAPixel * page.rows * page.cols,
                      page.compression == COMPRESSION_NONE ? 1 : kDeflateRatio, handle.name());
    const Samples samples(handle, page);
    const Area& area = page.area;
    image.resize(
        {static_cast<int>(area.bottom - area.top), static_cast<int>(area.right - area.left), 1});
    image.traits.filter = page.filter;
    image.traits.bits = page.bits;
    if (std::ranges::count(page.black_dn, page.black_dn.front()) == std::ssize(page.black_dn))
        image.traits.black_dn = static_cast<double>(page.black_dn.front());
    image.traits.white_dn = page.white_dn;
    image.traits.curve = "linear";  // by the standard, after its table
    auto* light = image.values.data();
    for (std::uint32_t row = area.top; row < area.bottom; ++row)
        for (std::uint32_t col = area.left; col < area.right; ++col) {
            std::size_t dn = samples.at(row, col);
            if (!page.linear.empty()) dn = page.linear[std::min(dn, page.linear.size() - 1)];
            const auto black = static_cast<double>(
                page.black_dn[(row - area.top) % page.black_rows * page.black_cols +
                              (col - area.left) % page.black_cols]);
            *light++ = static_cast<float>(std::max(0.0, static_cast<double>(dn) - black) /
                                          (page.white_dn - black));
        }
}

}  // namespace stipple
