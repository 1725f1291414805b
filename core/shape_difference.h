#pragma once

#include <string>
#include <string_view>

#include "core/geometry.h"

namespace stipple {

/// "640 x 480 x 3": width, height, planes.
[[nodiscard]] std::string shape_text(FrameShape shape);

/// Message on frames of a wrong shape: "has frames of 8 x 6 x 3 (width x height x planes), but the
/// reference has 8 x 6 x 1" for `others` = "but the reference has".
[[nodiscard]] std::string shape_difference(FrameShape found, FrameShape wanted,
                                           std::string_view others);

}  // namespace stipple
