#include "io/image_file.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string>

#include "core/error.h"
#include "core/input_file.h"
#include "io/footage_files.h"
#include "io/png_file.h"
#include "io/tiff_file.h"

namespace stipple {
namespace {

[[noreturn]] void fail_kind(const std::string& where) {
    throw InputError(where, "is not grey with 8 or 16 bits");
}

/// Row after row, each number as it is.
template <typename Sample>
DnImage dn_image(FrameShape shape, const void* samples) {
    const auto* const first = static_cast<const Sample*>(samples);
    return {shape, {first, first + shape.pixels()}};
}

DnImage read_dn_png(const std::string& where) {
    const PngImage png = decode_png(read_file(where), where);
    if (!png.as_stored) fail_kind(where);
    const PngPixels& pixels = png.pixels;
    const FrameShape shape{.rows = pixels.rows, .cols = pixels.cols, .planes = 1};
    if (pixels.bytes_per_sample == 2) return dn_image<std::uint16_t>(shape, pixels.bytes.data());
    return dn_image<std::uint8_t>(shape, pixels.bytes.data());
}

DnImage read_dn_tiff(const std::filesystem::path& file) {
    const TiffPixels pixels = read_single_tiff(file);
    if (pixels.channels != 1 || pixels.sample == TiffPixels::Sample::kF32) fail_kind(file.string());
    if (pixels.sample == TiffPixels::Sample::kU16)
        return dn_image<std::uint16_t>(pixels.shape, pixels.bytes.data());
    return dn_image<std::uint8_t>(pixels.shape, pixels.bytes.data());
}

}  // namespace

DnImage read_dn_image(const std::filesystem::path& file) {
    const std::string extension = lower_extension(file);
    if (extension == ".png") return read_dn_png(file.string());
    if (extension == ".tif" || extension == ".tiff") return read_dn_tiff(file);
    throw InputError(file.string(), "is not an image of digital numbers; give PNG or TIFF");
}

void write_dn_png(const std::filesystem::path& file, const std::string& where, FrameShape shape,
                  std::span<const std::uint16_t> dn) {
    assert(dn.size() == shape.pixels());
    PngPixels image{.rows = shape.rows,
                    .cols = shape.cols,
                    .bytes_per_sample = 2,
                    .bytes = std::vector<std::uint8_t>(dn.size_bytes())};
    std::memcpy(image.bytes.data(), dn.data(), dn.size_bytes());
    write_png_file(file, image, where);
}

}  // namespace stipple
