#pragma once

#include <array>
#include <cstdint>

namespace stipple {

using PhiloxCounter = std::array<std::uint32_t, 4>;

/// Philox4x32-10, a counter-based generator. The four words depend on (counter, key) only, not on
/// the order, the tiling or the number of threads. Source: Salmon et al., "Parallel random numbers:
/// as easy as 1, 2, 3", SC 2011.
[[nodiscard]] constexpr PhiloxCounter philox4x32(PhiloxCounter counter, std::uint64_t key) {
    auto [c0, c1, c2, c3] = counter;
    auto k0 = static_cast<std::uint32_t>(key);
    auto k1 = static_cast<std::uint32_t>(key >> 32U);
    for (int round = 0; round < 10; ++round) {
        const std::uint64_t p0 = std::uint64_t{0xD2511F53U} * c0;
        const std::uint64_t p1 = std::uint64_t{0xCD9E8D57U} * c2;
        c0 = static_cast<std::uint32_t>(p1 >> 32U) ^ c1 ^ k0;
        c2 = static_cast<std::uint32_t>(p0 >> 32U) ^ c3 ^ k1;
        c1 = static_cast<std::uint32_t>(p1);
        c3 = static_cast<std::uint32_t>(p0);
        k0 += 0x9E3779B9U;
        k1 += 0xBB67AE85U;
    }
    return {c0, c1, c2, c3};
}

/// Purpose of a random word, the low byte of counter word 2. A new purpose changes no other draw.
/// A new number for an old purpose changes the bits of streams and needs a new `kRandomLayout`.
enum class RandomPurpose : std::uint32_t {
    kSample = 0,
    kSchedule = 1,
    kFixedPattern = 2,
    kScene = 3,
    kColumnPattern = 4,
    kConverterPattern = 5,
    kRowNoise = 6,
    kColumnNoise = 7
};

/// Version of the counter layout, counter word 3. It defines the bits of every random draw.
inline constexpr std::uint32_t kRandomLayout = 1;

/// The counter of one draw: (site or pixel, slot, purpose and plane, layout).
[[nodiscard]] constexpr PhiloxCounter random_address(std::uint32_t pixel, std::uint32_t slot,
                                                     RandomPurpose purpose,
                                                     std::uint32_t plane = 0) {
    return {pixel, slot, static_cast<std::uint32_t>(purpose) | plane << 8U, kRandomLayout};
}

}  // namespace stipple
