#pragma once

#include <cstdint>

namespace stipple {

inline constexpr std::uint64_t kWords = std::uint64_t{1} << 32U;

/// The word whose probability u is (rank + 1/2) 2^-32: draws rise with the rank.
/// Precondition: rank < kWords.
[[nodiscard]] constexpr std::uint32_t ordered_word(std::uint64_t rank) {
    if (rank < kWords / 2) return static_cast<std::uint32_t>(rank << 1U) | 1U;
    return static_cast<std::uint32_t>((kWords - 1 - rank) << 1U);
}

}  // namespace stipple
