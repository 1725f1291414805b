#include "io/tiff_file.h"

#include <fmt/format.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "core/error.h"
#include "core/light.h"
#include "io/tiff_handle.h"

namespace stipple {
namespace {

/// How a page is laid out.
struct Page {
    std::uint32_t rows = 0;
    std::uint32_t cols = 0;
    std::uint16_t channels = 1;
    std::uint16_t bits = 1;
    std::uint16_t kind = SAMPLEFORMAT_UINT;
    std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
    std::uint16_t orientation = ORIENTATION_TOPLEFT;
    std::uint16_t compression = COMPRESSION_NONE;
    bool apart = false;  ///< one channel after the other
    bool has_profile = false;

    explicit Page(TIFF* tiff);
    [[nodiscard]] std::string problem() const;
    /// How many bytes of pixels a byte of the file can hold at most.
    [[nodiscard]] std::uint64_t max_packed() const;
};

Page::Page(TIFF* tiff) {
    std::uint16_t planar = PLANARCONFIG_CONTIG;
    TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &rows);
    TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &cols);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &channels);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &kind);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &planar);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &orientation);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &compression);
    TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
    std::uint32_t profile_bytes = 0;
    const void* profile = nullptr;
    has_profile = TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &profile_bytes, &profile) == 1;
    apart = planar == PLANARCONFIG_SEPARATE && channels > 1;
    if (compression == COMPRESSION_JPEG && photometric == PHOTOMETRIC_YCBCR) {
        TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB);
        photometric = PHOTOMETRIC_RGB;
    }
}

/// What keeps the page from being read; empty if nothing.
std::string Page::problem() const {
    const bool is_float = kind == SAMPLEFORMAT_IEEEFP;
    const bool is_unsigned = kind == SAMPLEFORMAT_UINT || kind == SAMPLEFORMAT_VOID;
    if (!(is_float && bits == 32) && !(is_unsigned && (bits == 8 || bits == 16)))
        return fmt::format(
            "holds samples of {} bits ({}); give 8- or 16-bit unsigned integers or "
            "32-bit floats",
            bits,
            is_float      ? "float"
            : is_unsigned ? "unsigned"
                          : "signed or complex");
    if (channels > 4) return fmt::format("holds {} channels; give grey or RGB", channels);
    const bool is_black_or_rgb =
        photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_RGB;
    const bool is_white = photometric == PHOTOMETRIC_MINISWHITE && channels == 1 && !is_float;
    if (!is_black_or_rgb && !is_white)
        return fmt::format(
            "its pixels are neither grey nor RGB (photometric interpretation {}); "
            "convert it first",
            photometric);
    if (orientation != ORIENTATION_TOPLEFT)
        return fmt::format(
            "its rows do not run from the top left (orientation {}); save it upright", orientation);
    return {};
}

std::uint64_t Page::max_packed() const {
    switch (compression) {
        case COMPRESSION_NONE:
            return 1;
        case COMPRESSION_PACKBITS:
            return 64;
        case COMPRESSION_DEFLATE:
        case COMPRESSION_ADOBE_DEFLATE:
            return kDeflateRatio;
        default:
            return std::uint64_t{1} << 16U;
    }
}

/// A page while it is read.
class PageReader {
  public:
    PageReader(TIFF* tiff, const Page& page, TiffPixels& pixels)
        : tiff_(tiff),
          pixels_(&pixels),
          apart_(page.apart),
          sample_(pixels.sample_bytes()),
          pixel_(sample_ * page.channels) {}

    /// False if it is damaged.
    [[nodiscard]] bool read() {
        const int channels = apart_ ? pixels_->channels : 1;
        for (int channel = 0; channel < channels; ++channel)
            if (!(TIFFIsTiled(tiff_) != 0 ? read_tiles(channel) : read_rows(channel))) return false;
        return true;
    }

  private:
    bool read_rows(int channel) {
        const auto cols = static_cast<std::uint32_t>(pixels_->shape.cols);
        std::vector<std::byte> row(static_cast<std::size_t>(TIFFScanlineSize64(tiff_)));
        if (row.size() < cols * stored_pixel()) return false;
        for (std::uint32_t y = 0; y < static_cast<std::uint32_t>(pixels_->shape.rows); ++y) {
            if (TIFFReadScanline(tiff_, row.data(), y, static_cast<std::uint16_t>(channel)) < 0)
                return false;
            store(row.data(), y, 0, cols, channel);
        }
        return true;
    }
    bool read_tiles(int channel) {
        const auto rows = static_cast<std::uint32_t>(pixels_->shape.rows);
        const auto cols = static_cast<std::uint32_t>(pixels_->shape.cols);
        std::uint32_t width = 0;
        std::uint32_t height = 0;
        TIFFGetField(tiff_, TIFFTAG_TILEWIDTH, &width);
        TIFFGetField(tiff_, TIFFTAG_TILELENGTH, &height);
        const std::uint64_t bytes = TIFFTileSize64(tiff_);
        const std::size_t row_bytes = width * stored_pixel();
        if (bytes == 0 || bytes < row_bytes * height) return false;
        std::vector<std::byte> tile(bytes);
        for (std::uint32_t y = 0; y < rows; y += height)
            for (std::uint32_t x = 0; x < cols; x += width) {
                if (TIFFReadTile(tiff_, tile.data(), x, y, 0, static_cast<std::uint16_t>(channel)) <
                    0)
                    return false;
                for (std::uint32_t row = 0; row < std::min(height, rows - y); ++row)
                    store(tile.data() + row * row_bytes, y + row, x, std::min(width, cols - x),
                          channel);
            }
        return true;
    }
    [[nodiscard]] std::size_t stored_pixel() const { return apart_ ? sample_ : pixel_; }

    /// Puts `count` stored pixels in place.
    void store(const std::byte* from, std::size_t row, std::size_t col, std::size_t count,
               int channel) {
        const auto cols = static_cast<std::size_t>(pixels_->shape.cols);
        std::byte* to = pixels_->bytes.data() + (row * cols + col) * pixel_;
        if (!apart_) {
            std::memcpy(to, from, count * pixel_);
            return;
        }
        to += static_cast<std::size_t>(channel) * sample_;
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(to + i * pixel_, from + i * sample_, sample_);
    }

    TIFF* tiff_;
    TiffPixels* pixels_;
    bool apart_;
    std::size_t sample_;  ///< bytes
    std::size_t pixel_;   ///< bytes, all channels
};

TiffPixels::Sample sample_of(const Page& page) {
    if (page.kind == SAMPLEFORMAT_IEEEFP) return TiffPixels::Sample::kF32;
    return page.bits == 8 ? TiffPixels::Sample::kU8 : TiffPixels::Sample::kU16;
}

}  // namespace

std::size_t TiffPixels::sample_bytes() const {
    return sample == Sample::kU8 ? 1 : sample == Sample::kU16 ? 2 : 4;
}

struct TiffFile::Impl {
    TiffHandle file;
    int pages = 1;
    int page = 0;  ///< the one at hand
    TiffTimes times;

    explicit Impl(const std::filesystem::path& path) : file(path) {}
    bool turn_to(int wanted);
    [[nodiscard]] TiffTimes declared_times() const;
};

/// The next page is found from this one, any other from the first.
bool TiffFile::Impl::turn_to(int wanted) {
    if (wanted == page) return true;
    const bool found = wanted == page + 1
                           ? TIFFReadDirectory(file.get()) != 0
                           : TIFFSetDirectory(file.get(), static_cast<tdir_t>(wanted)) != 0;
    page = wanted;
    return found;
}

/// What the first page, which is at hand, declares of all.
TiffTimes TiffFile::Impl::declared_times() const {
    const char* text = nullptr;
    if (TIFFGetField(file.get(), TIFFTAG_IMAGEDESCRIPTION, &text) != 1) return {};
    const Page first(file.get());
    return times_of_pages(text,
                          {.pages = static_cast<std::uint64_t>(pages),
                           .channels = std::max<std::uint64_t>(first.channels, 1),
                           .page_samples = std::uint64_t{first.rows} * first.cols * first.channels},
                          file.name());
}

TiffFile::TiffFile(const std::filesystem::path& file) : impl_(std::make_unique<Impl>(file)) {
    impl_->pages = static_cast<int>(TIFFNumberOfDirectories(impl_->file.get()));
    impl_->times = impl_->declared_times();
}

TiffFile::~TiffFile() = default;
TiffFile::TiffFile(TiffFile&&) noexcept = default;
TiffFile& TiffFile::operator=(TiffFile&&) noexcept = default;

int TiffFile::pages() const {
    return impl_->pages;
}

std::string TiffFile::where(int page) const {
    return impl_->pages == 1 ? impl_->file.name()
                             : fmt::format("{}: page {}", impl_->file.name(), page);
}

void TiffFile::read(int page, TiffPixels& pixels) {
    impl_->file.forget_message();
    if (!impl_->turn_to(page)) impl_->file.fail(where(page));
    TIFF* const tiff = impl_->file.get();
    const Page about(tiff);
    const std::string problem = about.problem();
    if (!problem.empty()) throw InputError(where(page), problem);
    pixels.sample = sample_of(about);
    pixels.channels = about.channels;
    pixels.times = impl_->times;
    pixels.has_profile = about.has_profile;
    pixels.shape = checked_shape(about.rows, about.cols, about.channels < 3 ? 1 : 3, where(page));
    const std::size_t bytes = pixels.shape.pixels() * about.channels * pixels.sample_bytes();
    impl_->file.check_size(bytes, bytes + sizeof(float) * pixels.shape.sites(), about.max_packed(),
                           where(page));
    pixels.bytes.resize(bytes);
    if (!PageReader(tiff, about, pixels).read()) impl_->file.fail(where(page));
    if (about.photometric == PHOTOMETRIC_MINISWHITE)
        for (std::byte& byte : pixels.bytes) byte = ~byte;
}

TiffPixels read_single_tiff(const std::filesystem::path& file) {
    TiffFile tiff(file);
    if (tiff.pages() != 1)
        throw InputError(file.string(),
                         fmt::format("holds {} images; save one image a file", tiff.pages()));
    TiffPixels pixels;
    tiff.read(0, pixels);
    return pixels;
}

}  // namespace stipple
