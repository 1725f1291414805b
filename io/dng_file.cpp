#include "io/dng_file.h"

#include <tiffio.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/light.h"
#include "io/pixel_format.h"
#include "io/tiff_handle.h"

namespace stipple {
namespace {

/// The stored numbers, by row and column of the whole image.
class Samples {
  public:
    Samples(const TiffHandle& handle, const DngPage& page)
        : handle_(handle), page_(page), all_(std::size_t{page.rows} * page.cols) {
        format_.bits_per_pixel = format_.significant_bits = page.bits;
        // libtiff turns words of 16 bits into those of this machine.
        format_.packing = page.bits % 8 == 0 ? Packing::kBytes : Packing::kMsbPacked;
        if (page.compression == COMPRESSION_JPEG)
            read_jpeg();
        else
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
    void read_jpeg();
    /// \throws InputError if there are none, or too large ones.
    [[nodiscard]] FrameShape tile_shape() const;
    void put_row(std::uint32_t y, std::uint32_t x, std::span<const std::uint16_t> samples) {
        std::copy_n(samples.begin(), std::min(samples.size(), std::size_t{page_.cols} - x),
                    all_.begin() + static_cast<std::ptrdiff_t>(std::size_t{y} * page_.cols + x));
    }

    const TiffHandle& handle_;
    const DngPage& page_;
    PixelFormat format_;
    std::vector<std::uint16_t> all_;
};

FrameShape Samples::tile_shape() const {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    if (TIFFGetField(handle_.get(), TIFFTAG_TILEWIDTH, &width) != 1 ||
        TIFFGetField(handle_.get(), TIFFTAG_TILELENGTH, &height) != 1 || width < 1 ||
        width > kMaxFrameSide || height < 1 || height > kMaxFrameSide)
        handle_.fail(handle_.name());
    return {static_cast<int>(height), static_cast<int>(width), 1};
}

void Samples::read_tiles() {
    const FrameShape tiles = tile_shape();
    const auto height = static_cast<std::uint32_t>(tiles.rows);
    const auto width = static_cast<std::uint32_t>(tiles.cols);
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
                put_row(y + row, x, samples);
            }
        }
}

/// Tiles or strips, each a JPEG file, of which libtiff reads the bytes alone.
void Samples::read_jpeg() {
    tiff* const file = handle_.get();
    const bool tiled = TIFFIsTiled(file) != 0;
    std::uint32_t strip_rows = page_.rows;
    if (!tiled) TIFFGetFieldDefaulted(file, TIFFTAG_ROWSPERSTRIP, &strip_rows);
    strip_rows = std::clamp(strip_rows, 1U, page_.rows);
    const FrameShape shape =
        tiled ? tile_shape()
              : FrameShape{static_cast<int>(strip_rows), static_cast<int>(page_.cols), 1};
    const auto height = static_cast<std::uint32_t>(shape.rows);
    const auto width = static_cast<std::uint32_t>(shape.cols);
    std::vector<std::uint8_t> jpeg;
    std::vector<std::uint16_t> samples;
    for (std::uint32_t y = 0; y < page_.rows; y += height)
        for (std::uint32_t x = 0; x < page_.cols; x += width) {
            const std::uint32_t rows = std::min(height, page_.rows - y);
            const std::uint32_t piece =
                tiled ? TIFFComputeTile(file, x, y, 0, 0) : TIFFComputeStrip(file, y, 0);
            const std::uint64_t bytes = TIFFGetStrileByteCount(file, piece);
            if (bytes > handle_.file_bytes()) handle_.fail(handle_.name());
            jpeg.resize(bytes);
            const auto size = static_cast<tmsize_t>(bytes);
            if ((tiled ? TIFFReadRawTile(file, piece, jpeg.data(), size)
                       : TIFFReadRawStrip(file, piece, jpeg.data(), size)) != size)
                handle_.fail(handle_.name());
            samples.resize(std::size_t{width} * (tiled ? height : rows));
            decode_lossless_jpeg(jpeg, handle_.name(), samples);
            for (std::uint32_t row = 0; row < rows; ++row)
                put_row(y + row, x, std::span(samples).subspan(std::size_t{row} * width, width));
        }
}

}  // namespace

void read_dng(const std::filesystem::path& file, Image& image) {
    const TiffHandle handle(file);
    image.traits = {};
    read_dng_camera(handle, image.traits);
    find_raw(handle);
    const DngPage page(handle.get(), handle.name());
    const std::uint64_t stored =
        std::uint64_t{page.rows} *
        ((std::uint64_t{page.cols} * static_cast<unsigned>(page.bits) + 7) / 8);
    constexpr std::uint64_t kBytesAPixel = sizeof(std::uint16_t) + sizeof(float);
    handle.check_size(stored, kBytesAPixel * page.rows * page.cols,
                      page.compression == COMPRESSION_NONE ? 1 : kDeflateRatio, handle.name());
    const Samples samples(handle, page);
    const DngArea& area = page.area;
    image.resize(
        {static_cast<int>(area.bottom - area.top), static_cast<int>(area.right - area.left), 1});
    image.traits.filter = page.filter;
    image.traits.bits = page.bits;
    add_dng_warnings(handle.get(), image.traits);
    if (page.has_one_black()) image.traits.black_dn = static_cast<double>(page.black_dn.front());
    image.traits.white_dn = page.white_dn;
    image.traits.curve = "linear";  // by the standard, after its table
    auto* light = image.values.data();
    for (std::uint32_t row = area.top; row < area.bottom; ++row)
        for (std::uint32_t col = area.left; col < area.right; ++col) {
            std::size_t dn = samples.at(row, col);
            if (!page.linear.empty()) dn = page.linear[std::min(dn, page.linear.size() - 1)];
            const double black = page.black_at(row - area.top, col - area.left);
            *light++ = static_cast<float>(std::max(0.0, static_cast<double>(dn) - black) /
                                          (page.white_dn - black));
        }
}

}  // namespace stipple
