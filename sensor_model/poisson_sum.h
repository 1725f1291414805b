#pragma once

#include <array>
#include <cstddef>

namespace stipple::poisson_sum {

// Constants for the summation of Poisson terms in double, of the scalar and the SIMD form.

/// exp(r) = sum r^i / i!, enough for |r| <= ln(2) / 2; the lowest power first.
inline constexpr double kExp[] = {
    1,         1,          1.0 / 2,     1.0 / 6,      1.0 / 24,      1.0 / 120,
    1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800};
inline constexpr double kLog2E = 1.4426950408889634;
inline constexpr double kLn2High = 0.693147180369123816490;  // exact products with small integers
inline constexpr double kLn2Low = 1.90821492927058770002e-10;

/// Max number of terms: P(X > 127) < 1e-37 at mean 32.
inline constexpr std::size_t kTerms = 128;

/// kReciprocal[k] = 1 / (k + 1): a product costs less than a division.
inline constexpr auto kReciprocal = [] {
    std::array<double, kTerms> reciprocal{};
    for (std::size_t k = 0; k < kTerms; ++k) reciprocal[k] = 1.0 / static_cast<double>(k + 1);
    return reciprocal;
}();

}  // namespace stipple::poisson_sum
