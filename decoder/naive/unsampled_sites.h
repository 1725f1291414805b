#pragma once

#include <cstdint>
#include <span>

#include "core/flux_video.h"

namespace stipple {

/// Fills the sites without samples (`sampled` is 0; order (plane, row, col)) from their
/// surroundings, slot by slot. The guide is the plane with the most samples. In it a site becomes
/// the weighted mean of its known neighbours of 8, with weights 2 along rows and columns and 1
/// along diagonals; then the sites around it follow. If the four nearest neighbours are known and
/// another plane measures the pixel, the interpolation follows the row or the column, whichever
/// varies less, with the curvature of that plane (Hamilton and Adams, US 5629734). The other planes
/// become the guide plus their difference from it, which is interpolated in the same way: on a
/// colour filter array, bilinear interpolation of R - G and B - G. Filled values are not negative.
/// A plane without any sample equals the guide.
void fill_unsampled(std::span<const std::uint8_t> sampled, FluxVideo& x);

}  // namespace stipple
