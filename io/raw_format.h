#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "io/pixel_format.h"
#include "io/raw_video.h"

namespace stipple {

/// How to read a file of frames that has no header of its own.
struct RawFormat {
    std::string text;  ///< that it was parsed of
    std::uint64_t rows = 0;
    std::uint64_t cols = 0;
    PixelFormat format;
    std::uint64_t offset = 0;             ///< bytes before the first frame
    std::optional<std::uint64_t> stride;  ///< bytes from frame to frame; without: there are no gaps
    std::optional<std::uint64_t> frames;  ///< before other bytes; without: the file ends with them
    double black_dn = 0;                  ///< DN of no light
    std::optional<double> frames_hz;      ///< at which they were taken
};

/// Parses "640x480:mono12p", columns x rows and a pixel format of the PFNC in any case, "msb" in
/// place of "p" for samples from their highest bit on. After further colons may come "offset=512",
/// "stride=8192" (bytes), "frames=100", "black=64" (DN) and "hz=1000". \throws InputError naming
/// the text.
[[nodiscard]] RawFormat parse_raw_format(std::string_view text);

/// The frames of such a file. \throws InputError if it is unreadable, has fewer frames than wanted,
/// or if without a wanted number its length is not that of whole frames.
[[nodiscard]] RawVideo open_raw_file(const std::filesystem::path& file, const RawFormat& format);

}  // namespace stipple
