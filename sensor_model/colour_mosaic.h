#pragma once

#include <span>

#include "core/colour_filter.h"
#include "core/geometry.h"

namespace stipple {

/// RGB light behind a colour filter array: each pixel of `mosaic` gets the plane of its filter.
/// `frame` has `shape`, order (plane, row, col); `mosaic` has shape.pixels() values.
/// Precondition: shape.planes == 3, filter is not kNone.
///
/// Not modelled: spectra of filters (no crosstalk of colours, no loss of light), optical low-pass.
void take_mosaic(ColourFilter filter, FrameShape shape, std::span<const float> frame,
                 std::span<float> mosaic);

}  // namespace stipple
