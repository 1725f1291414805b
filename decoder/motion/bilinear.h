#pragma once

#include <algorithm>

#include "core/plane.h"

namespace stipple {

/// The value between four pixels, bilinear; what lies outside is that of the rim.
[[nodiscard]] inline float bilinear(PlaneView<const float> plane, float row, float col) {
    row = std::clamp(row, 0.0F, static_cast<float>(plane.rows() - 1));
    col = std::clamp(col, 0.0F, static_cast<float>(plane.cols() - 1));
    const int top = static_cast<int>(row);
    const int left = static_cast<int>(col);
    const int bottom = std::min(top + 1, plane.rows() - 1);
    const int right = std::min(left + 1, plane.cols() - 1);
    const float down = row - static_cast<float>(top);
    const float across = col - static_cast<float>(left);
    const float above = plane(top, left) + across * (plane(top, right) - plane(top, left));
    const float below = plane(bottom, left) + across * (plane(bottom, right) - plane(bottom, left));
    return above + down * (below - above);
}

}  // namespace stipple
