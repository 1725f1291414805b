#pragma once

#include <filesystem>
#include <string>

#include "core/late_opencv.h"
#include "io/png_chunks.h"

namespace stipple {

/// \throws InputError if the file cannot be decoded.
[[nodiscard]] PngPixels decode_png(const PngChunks& png, PngLayout layout,
                                   const std::string& place);

/// \throws DeviceError if the file cannot be written.
void write_png_file(const std::filesystem::path& file, PngPixels& pixels);

}  // namespace stipple
