#pragma once

#include <cstddef>

namespace stipple {

/// c[0] + c[1] x + c[2] x^2 + ..., each step a rounded product and a rounded sum (never fused), so
/// that the SIMD form can repeat it bit by bit.
template <typename T, std::size_t n>
[[nodiscard]] constexpr T horner(const T (&c)[n], T x) noexcept {
    T sum = c[n - 1];
    for (std::size_t i = n - 1; i > 0; --i) sum = sum * x + c[i - 1];
    return sum;
}

}  // namespace stipple
