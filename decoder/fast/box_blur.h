#pragma once

#include <span>

#include "core/geometry.h"

namespace stipple {

/// Each pixel of a plane becomes the mean of the box of 7 x 7 pixels around it, whose standard
/// deviation is 2; borders are repeated. Precondition: plane.size() == shape.pixels().
void box_blur(FrameShape shape, std::span<float> plane);

}  // namespace stipple
