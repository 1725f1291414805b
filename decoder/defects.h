#pragma once

#include <cstddef>

namespace stipple {

struct Measurements;

/// Takes out the samples of pixels that are stuck, so that a regulariser fills them from around,
/// and returns how many sites that are. A site of four samples or more is stuck if all but two or
/// fewer of the sites next to it (eight, at the border fewer, those with samples, three at least)
/// are sound, and
/// - all its samples are saturated, and say at least three times the light of every sound one; or
/// - its samples together are within three standard deviations of no light, where the light of the
///   darkest sound one would be twenty.
/// Sound is what is neither all saturated nor all dark. Not found: defects side by side in larger
/// groups, in planes of a mosaic whose next sites are of another colour, or that come and go. A
/// single bright or black point that is still for a whole block, with a sharp edge all around,
/// looks the same and is lost.
std::size_t mask_defects(Measurements& measurements);

}  // namespace stipple
