#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace stipple {

/// What a decoder needs of a PNG file, and nothing that makes it print warnings.
struct PngChunks {
    std::vector<std::uint8_t> file;  ///< signature and critical chunks
    bool grey = false;               ///< greyscale, with or without alpha
    bool has_alpha = false;          ///< or a transparent colour
    bool gamma_coded = false;        ///< by its sRGB or gAMA chunk, else if 8-bit colour
};

/// Checks the lengths and CRCs of a PNG file and drops its ancillary chunks (colour profiles,
/// text, time, transparency).
/// \throws InputError with the byte offset at which the file is damaged or ends too early.
/// Source: W3C PNG specification, sections 5 and 11.
[[nodiscard]] PngChunks critical_png_chunks(std::span<const std::uint8_t> bytes,
                                            std::string_view place);

}  // namespace stipple
