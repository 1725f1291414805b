#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "io/picture.h"

namespace stipple {

/// The pixels of a PNG file.
struct PngPixels {
    int rows = 0;
    int cols = 0;
    int channels = 1;  ///< grey, or 3: red, green, blue
    int bytes_a_sample = 1;
    std::vector<std::uint8_t> bytes;  ///< row after row; samples of 2 bytes as the machine has them
};

struct PngImage {
    PngPixels pixels;
    SourceTraits traits;
    bool as_stored = true;  ///< grey of 8 or 16 bits, without alpha: the numbers of the file
};

/// Decodes the bytes of a PNG file. A palette becomes colours, fewer than 8 bits of grey become 8;
/// alpha is left out.
/// \throws InputError if it is none, is damaged or ends too early, with the byte offset of the
/// chunk; or if the picture is larger than it may be.
[[nodiscard]] PngImage decode_png(std::span<const std::uint8_t> file, const std::string& place);

/// \throws DeviceError if the file cannot be written.
void write_png_file(const std::filesystem::path& file, const PngPixels& pixels);

}  // namespace stipple
