#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "core/geometry.h"
#include "io/image.h"

namespace stipple {

/// Reads an OpenEXR image (half or float) into `image`: its channels R, G, B, else Y, else its
/// only channel if that is not depth. Alpha and other channels are omitted. Colours of other
/// primaries than those of Rec. 709 are converted (io/primaries.h), nothing is scaled. The image is
/// that of the display window; pixels outside of the data window are 0. \throws InputError naming
/// the file if it is unreadable or truncated, or has none of these channels.
void read_exr(const std::filesystem::path& file, Image& image);

enum class ExrSample { kFloat, kHalf };

/// Writes an OpenEXR image: float or half (light up to 65504, brighter is clipped), ZIP
/// compression, channels R, G, B or Y. The same frame gives the same bytes. `frame` holds
/// shape.sites() floats, order (plane, row, col); `where` names the output in messages. \throws
/// DeviceError.
void write_exr(const std::filesystem::path& file, std::string_view where, FrameShape shape,
               std::span<const float> frame, ExrSample sample = ExrSample::kFloat);

}  // namespace stipple
