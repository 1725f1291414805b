#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry.h"
#include "io/image.h"
#include "io/tiff_file.h"

namespace stipple {

/// A format of images that are read.
struct ImageReader {
    std::string_view name;                       ///< "PNG"
    std::array<std::string_view, 2> extensions;  ///< in lower case, with the dot; empty: no second
    void (*read)(const std::filesystem::path& file, Image& image);  ///< as read_image
};

/// All formats, in the order of docs/footage.md.
[[nodiscard]] std::span<const ImageReader> image_readers();

/// That of a file, by its extension in upper or lower case; null: there is none.
[[nodiscard]] const ImageReader* image_reader(const std::filesystem::path& file);

/// "PNG, TIFF, EXR or DNG".
[[nodiscard]] std::string image_format_names();

/// Reads an image, a TIFF file of one page. \throws InputError naming the file, and the offset
/// where known, if it is missing, unreadable, truncated, of no format of `image_readers`, or
/// neither mono nor RGB.
void read_image(const std::filesystem::path& file, Image& image);

/// A page of a TIFF file.
void to_image(const TiffPixels& pixels, Image& image);

/// Writes linear light as an 8-bit PNG image through the curve of io/tone_map.h. `frame` holds
/// shape.sites() floats, order (plane, row, col). Replaces `file`, which messages call `where`.
/// \throws DeviceError.
void write_png(const std::filesystem::path& file, const std::string& where, FrameShape shape,
               std::span<const float> frame);

/// One plane of digital numbers of a camera, without scaling.
struct DnImage {
    FrameShape shape{.rows = 0, .cols = 0, .planes = 1};
    std::vector<std::uint16_t> dn;  ///< by row and column
};

/// Reads a grey PNG or TIFF file of 8 or 16 bits. \throws InputError naming the file, and the
/// offset where known, if it is missing, unreadable, truncated or of another kind.
[[nodiscard]] DnImage read_dn_image(const std::filesystem::path& file);

/// Writes a 16-bit grey PNG file, replacing `file`, which messages call `where`. Precondition:
/// dn.size() == rows * cols of shape. \throws DeviceError.
void write_dn_png(const std::filesystem::path& file, const std::string& where, FrameShape shape,
                  std::span<const std::uint16_t> dn);

}  // namespace stipple
