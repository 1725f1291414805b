#pragma once

#include <array>

namespace stipple {

/// A 3 x 3 matrix by rows.
using ColourMatrix = std::array<std::array<float, 3>, 3>;

/// The axes along which colours with this covariance vary independently: its eigenvectors,
/// orthonormal, one a column, by growing variance. The same bits everywhere, as it takes square
/// roots and the four operations only. Precondition: symmetric, finite.
[[nodiscard]] ColourMatrix principal_colour_axes(const ColourMatrix& covariance) noexcept;

}  // namespace stipple
