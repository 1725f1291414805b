#pragma once

#include "core/plane.h"

namespace stipple {

/// Each pixel of `to` becomes the mean light of the area that it covers in `from`, whose pixels at
/// the borders count by their share. So the mean of the plane is kept, and no light is negative.
/// Precondition: `to` has at least one row and column, and no more of either than `from`.
void average_areas(PlaneView<const float> from, PlaneView<float> to);

}  // namespace stipple
