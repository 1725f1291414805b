#pragma once

#include <cstddef>
#include <span>

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

// Variance-stabilising transform: 2 sqrt(x + offset) of each plane (Anscombe 1948), after which
// noise has the same variance everywhere. Three planes are then transformed to luma and two
// opponents, as above. Frames have the order (plane, row, col).

/// Light below `min_light` is replaced by `min_light`. Precondition: 0 <= -min_light <= offset.
struct AnscombeParams {
    float offset;
    float min_light = 0;
};

void stabilise_variance(std::span<const float> light, int planes, AnscombeParams scale,
                        std::span<float> stabilised);

/// The inverse; the result is at least `min_light`.
void restore_light(std::span<const float> stabilised, int planes, AnscombeParams scale,
                   std::span<float> light);

}  // namespace stipple
