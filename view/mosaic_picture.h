#pragma once

#include <span>
#include <vector>

#include "core/colour_filter.h"
#include "core/geometry.h"

namespace stipple {

/// A picture of a mosaic in three planes, order (plane, row, col): each pixel has the mean light of
/// each colour in its cell of 2 x 2 pixels. Pixels beyond the last whole cell belong to it.
/// Precondition: `shape`, that of the mosaic, has one plane; `filter` is one.
[[nodiscard]] std::vector<float> coloured(std::span<const float> mosaic, FrameShape shape,
                                          ColourFilter filter);

}  // namespace stipple
