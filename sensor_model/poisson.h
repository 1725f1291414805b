#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// Max mean of a draw, in counts; larger means are reduced to it.
inline constexpr float kMaxPoissonMean = 1e9F;

/// Poisson draw with the given mean, the quantile of one random word: the smallest k with
/// P(X <= k) >= u. Word bit 0 and the rest give u as in `normal_one`. A slightly brighter scene
/// therefore gives the same draws or slightly larger ones. The accuracy table is in
/// docs/sensor_model.md. This is the scalar reference of `poisson`.
/// Precondition: mean >= 0, not NaN.
///
/// Method: for means below 4 the sum of the terms in double; below 100 Temme's expansion of the
/// incomplete gamma function at the normal quantile, and for means below 32 the sum if the result
/// is too close to an integer or far in a tail; above, a shorter fit of the same expansion.
/// Source: M. Giles, "Algorithm 955: approximation of the inverse Poisson cumulative distribution
/// function", ACM Trans. Math. Softw. 42 (2016).
[[nodiscard]] std::uint32_t poisson_one(float mean, std::uint32_t word) noexcept;

/// The same quantile by summing p_k = p_(k-1) mean / k in double: exact but for rounding (1e-14).
/// Precondition: 0 <= mean <= 32.
[[nodiscard]] std::uint32_t poisson_by_sum(float mean, std::uint32_t word) noexcept;

/// `count[i] = poisson_one(mean[i], word[i])`, the same bits on every SIMD target.
/// Precondition: equal lengths; no mean is negative or NaN.
void poisson(std::span<const float> mean, std::span<const std::uint32_t> word,
             std::span<std::uint32_t> count) noexcept;

}  // namespace stipple
