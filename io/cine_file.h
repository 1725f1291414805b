#pragma once

#include <filesystem>

#include "io/raw_video.h"

namespace stipple {

/// The frames of a .cine file of a Phantom camera: grey or behind a colour filter array, of 8 to 16
/// bits, or packed in 10 or 12. Light is 0 at the black level and 1 at the white level that the
/// file declares, else at 2^bits - 1; numbers of 10 bits go through the curve of BT.709, as which
/// their published table is read to 1.2 of its 4000 steps. \throws InputError if the file is
/// damaged or of a kind that is not read.
[[nodiscard]] RawVideo open_cine(const std::filesystem::path& file);

}  // namespace stipple
