#pragma once

#include <cstdint>
#include <span>

#include "core/flux_video.h"

namespace stipple {

/// Fills the sites that no sample tells of (`sampled` is 0; order (plane, row, col)) from those
/// around them, slot by slot. In the plane with the most samples, the guide, a site becomes the
/// mean of its 8 neighbours, weights 2 along rows and columns and 1 across, as far as they are
/// known; then the sites around it, and so on. Where its four next neighbours are known and another
/// plane sees the pixel, it continues along rows or columns, as the light around does, with the
/// curvature of that plane (Hamilton and Adams, US 5629734). The other planes become the guide plus
/// their difference from it, which is spread in the same way: on a colour filter array, bilinear
/// interpolation of R - G and B - G. What is filled is not negative; a plane without
/// any sample equals the guide.
void fill_unsampled(std::span<const std::uint8_t> sampled, FluxVideo& x);

}  // namespace stipple
