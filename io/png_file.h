#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/image.h"

namespace stipple {

/// Adds to `traits` what chunks of a PNG file declare of its numbers: the transfer function (cICP,
/// else iCCP, else sRGB, else gAMA), primaries of `colour`, significant bits, shape of a pixel and
/// orientation. Chunks of wrong lengths are left out.
/// \throws InputError at `where` if it is an animation or of limited range.
void add_png_declarations(std::span<const std::uint8_t> file, bool colour, const std::string& where,
                          SourceInfo& traits);

/// The pixels of a PNG file.
struct PngPixels {
    int rows = 0;
    int cols = 0;
    int channels = 1;  ///< 1: grey; 3: red, green, blue
    int bytes_per_sample = 1;
    std::vector<std::uint8_t>
        bytes;  ///< by rows; samples of 2 bytes in the byte order of the machine
};

struct PngImage {
    PngPixels pixels;
    SourceInfo traits;
    bool as_stored = true;  ///< the numbers of the file: grey of 8 or 16 bits, without alpha
};

/// Decodes the bytes of a PNG file. Palettes are converted to colours, grey of fewer than 8 bits to
/// 8 bits; alpha is omitted.
/// \throws InputError if it is no PNG file, is damaged or truncated, with the byte offset of the
/// chunk; or if the image exceeds the maximum size.
[[nodiscard]] PngImage decode_png(std::span<const std::uint8_t> file, const std::string& where);

/// Messages call the file `where`. \throws DeviceError if it cannot be written.
void write_png_file(const std::filesystem::path& file, const PngPixels& pixels,
                    const std::string& where);

}  // namespace stipple
