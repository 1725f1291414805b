#include "decoder/best/colour_axes.h"

#include <cmath>
#include <cstddef>

namespace stipple {
namespace {

constexpr int kSweeps = 5;  // they converge quadratically: more than float can show

struct Rotation {
    float cosine = 1;
    float sine = 0;
};

/// The smaller of the two angles at which the element (a, b) becomes 0.
Rotation annihilating(const ColourMatrix& m, std::size_t a, std::size_t b) {
    if (m[a][b] == 0) return {};
    const float half = (m[b][b] - m[a][a]) / (2 * m[a][b]);
    const float tangent = (half < 0 ? -1.0F : 1.0F) / (std::abs(half) + std::sqrt(half * half + 1));
    const float cosine = 1 / std::sqrt(tangent * tangent + 1);
    return {cosine, tangent * cosine};
}

void rotate(const Rotation& by, float& x, float& y) {
    const float first = by.cosine * x - by.sine * y;
    y = by.sine * x + by.cosine * y;
    x = first;
}

}  // namespace

ColourMatrix principal_colour_axes(ColourMatrix covariance) noexcept {
    ColourMatrix& m = covariance;
    ColourMatrix axes = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (std::size_t a = 0; a < 2; ++a)
            for (std::size_t b = a + 1; b < 3; ++b) {
                const Rotation by = annihilating(m, a, b);
                for (auto& row : m) rotate(by, row[a], row[b]);
                for (std::size_t col = 0; col < 3; ++col) rotate(by, m[a][col], m[b][col]);
                for (auto& row : axes) rotate(by, row[a], row[b]);
            }
    return axes;
}

}  // namespace stipple
