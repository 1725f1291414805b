#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "core/geometry.h"

namespace stipple {

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
