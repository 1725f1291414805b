#pragma once

namespace stipple {

/// (1 - x / 16)^16, which is near exp(-x), and 0 from x = 16 on. The same bits everywhere, which
/// no library guarantees of exp. Precondition: x >= 0.
[[nodiscard]] inline float fast_gaussian(float x) {
    const float root = 1 - x / 16;
    if (!(root > 0)) return 0;
    const float power4 = (root * root) * (root * root);
    return (power4 * power4) * (power4 * power4);
}

}  // namespace stipple
