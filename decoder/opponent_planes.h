#pragma once

#include <cstddef>

namespace stipple {

/// The same pixels of three planes.
struct PlaneTriple {
    float* first;
    float* second;
    float* third;
};

// The orthonormal transform of R, G, B to luma and two opponents,
//   (R + G + B) / sqrt(3), (R - B) / sqrt(2), (R - 2 G + B) / sqrt(6),
// in place, and its inverse, which is its transpose. The same bits for any SIMD width.

void to_opponents(std::size_t count, const PlaneTriple& planes) noexcept;
void from_opponents(std::size_t count, const PlaneTriple& planes) noexcept;

}  // namespace stipple
