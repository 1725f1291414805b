#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// Standard normal deviate of one random word. Bit 0 is the sign (1 = negative); the tail
/// probability is (word / 2 + 1/2) 2^-32, so |z| falls as word / 2 grows and |z| < 6.4. Mean and
/// variance over all words: 0 and 1 within 1e-7.
/// Source: M. Giles, "Approximating the erfinv function", GPU Computing Gems 2 (2011).
[[nodiscard]] float normal_one(std::uint32_t word) noexcept;

/// `value[i] = normal_one(word[i])`, the same bits on every SIMD target.
/// Precondition: equal lengths.
void normal(std::span<const std::uint32_t> word, std::span<float> value) noexcept;

}  // namespace stipple
