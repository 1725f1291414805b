#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "io/image.h"

namespace stipple {

/// Adds to `traits` what chunks of a PNG file declare of its numbers: the transfer function (cICP,
/// else iCCP, else sRGB, else gAMA), primaries of `colour`, significant bits, shape of a pixel and
/// orientation. Chunks of wrong lengths are left out.
/// \throws InputError at `where` if it is an animation or of limited range.
void add_png_declarations(std::span<const std::uint8_t> file, bool colour, const std::string& where,
                          SourceInfo& traits);

}  // namespace stipple
