#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace stipple {

/// \throws InputError if a TIFF file holds more than one picture, of which a decoder would
/// silently read the first only. Bytes that are no TIFF pass: the decoder refuses them.
/// Source: TIFF 6.0, section 2 (image file header and directory).
void check_single_tiff_page(std::span<const std::uint8_t> bytes, std::string_view place);

}  // namespace stipple
