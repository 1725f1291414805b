#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/geometry.h"
#include "io/image.h"
#include "io/tiff_file.h"

namespace stipple {

/// Reads a .png, .tif, .tiff, .exr or .dng file (by extension) into `image`, a TIFF file of one
/// page. \throws InputError naming the file, and the offset where known, if it is missing,
/// unreadable, truncated, or neither mono nor RGB.
void read_image(const std::filesystem::path& file, Image& image);

/// A page of a TIFF file.
void to_image(const TiffPixels& pixels, Image& image);

/// Writes linear light as an 8-bit PNG image through the curve of io/tone_map.h. `frame` holds
/// shape.sites() floats, order (plane, row, col). Replaces `file`, which messages call `where`.
/// \throws DeviceError.
void write_png(const std::filesystem::path& file, const std::string& where, FrameShape shape,
               std::span<const float> frame);

}  // namespace stipple
