#pragma once

#include <array>

namespace stipple {

/// A 3 x 3 matrix by rows.
using ColourMatrix = std::array<std::array<float, 3>, 3>;

/// Principal axes of colours with this covariance: its eigenvectors, orthonormal, one per column,
/// by increasing variance. The same bits everywhere, because it uses square roots and the four
/// operations only. Precondition: symmetric, finite.
[[nodiscard]] ColourMatrix principal_colour_axes(const ColourMatrix& covariance) noexcept;

}  // namespace stipple
