#pragma once

#include <string>

#include "core/geometry.h"

namespace stipple {

/// Takes "640x480", width and height, into `shape`. \throws UsageError naming `option` if
/// it is no such text or a side is outside least..most pixels.
void parse_size(const std::string& option, const std::string& text, int least, int most,
                FrameShape& shape);

}  // namespace stipple
