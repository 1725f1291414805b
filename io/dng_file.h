#pragma once

#include <filesystem>

#include "io/image.h"

namespace stipple {

/// Reads the raw image of a .dng file (DNG 1.4, CinemaDNG): grey or the mosaic of a colour filter
/// array, 8 to 16 bits, not compressed or by Deflate, its active area. Light is 0 at the black and
/// 1 at the white level of the file. \throws InputError if it is damaged or of another kind.
void read_dng(const std::filesystem::path& file, Image& image);

}  // namespace stipple
