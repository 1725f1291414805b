#pragma once

#include <bit>
#include <cstdint>

#include "sensor_model/horner.h"
#include "sensor_model/poisson_sum.h"

namespace stipple {

/// 2^x, relative error below 1e-13, the same bits everywhere (no libm). Precondition: |x| < 1000.
[[nodiscard]] inline double power_of_two(double x) noexcept {
    const auto whole = static_cast<std::int32_t>(x < 0 ? x - 0.5 : x + 0.5);
    const double rest = (x - whole) * (poisson_sum::kLn2High + poisson_sum::kLn2Low);
    const auto exponent = static_cast<std::uint64_t>(1023 + whole) << 52U;
    return horner(poisson_sum::kExp, rest) * std::bit_cast<double>(exponent);
}

}  // namespace stipple
