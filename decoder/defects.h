#pragma once

#include <cstddef>

namespace stipple {

struct Measurements;

/// Removes the samples of stuck pixels, so that the prior fills them, and returns the number of
/// these sites. A site with at least four samples is stuck if at most two of its neighbours with
/// samples are unsound (of up to eight neighbours, at least three of them with samples), and
/// - all its samples are saturated, and their bound is at least three times the light of every
///   sound neighbour; or
/// - the sum of its samples is within three standard deviations of no light, and the light of the
///   darkest sound neighbour is at least twenty standard deviations.
/// A site is sound if its samples are neither all saturated nor all dark. Not detected: larger
/// groups of adjacent defects, defects in planes of a mosaic whose neighbouring sites have another
/// colour, and intermittent defects. A single bright or black point that is static for a whole
/// block, with a sharp edge all around, cannot be distinguished from a defect and is lost.
std::size_t mask_defects(Measurements& measurements);

}  // namespace stipple
