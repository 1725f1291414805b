#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "sensor_model/poisson_sum.h"

namespace stipple {

/// c[0] + c[1] x + c[2] x^2 + ..., each step a rounded product and a rounded sum (never fused), so
/// that the SIMD form can repeat it bit by bit.
template <typename T, std::size_t n>
[[nodiscard]] constexpr T horner(const T (&c)[n], T x) noexcept {
    T sum = c[n - 1];
    for (std::size_t i = n - 1; i > 0; --i) sum = sum * x + c[i - 1];
    return sum;
}

/// 2^x, relative error below 1e-13, the same bits everywhere (no libm). Precondition: |x| < 1000.
[[nodiscard]] inline double power_of_two(double x) noexcept {
    const auto whole = static_cast<std::int32_t>(x < 0 ? x - 0.5 : x + 0.5);
    const double rest = (x - whole) * (poisson_sum::kLn2High + poisson_sum::kLn2Low);
    const auto exponent = static_cast<std::uint64_t>(1023 + whole) << 52U;
    return horner(poisson_sum::kExp, rest) * std::bit_cast<double>(exponent);
}

}  // namespace stipple
