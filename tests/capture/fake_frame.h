#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stipple {

/// The bytes of a frame of the fake camera: noise that its id decides.
inline void fill_fake_frame(std::span<std::uint8_t> bytes, std::uint64_t id) {
    std::uint64_t state = id * 0x9E3779B97F4A7C15U + 1;
    for (std::uint8_t& byte : bytes) {  // xorshift64 (Marsaglia 2003)
        state ^= state << 13U;
        state ^= state >> 7U;
        state ^= state << 17U;
        byte = static_cast<std::uint8_t>(state >> 32U);
    }
}

/// The device stamp of the fake camera's n-th frame.
inline std::uint64_t fake_stamp_ns(std::uint64_t number) {
    return 1'000'000'000 + number * 5'000'000;
}

}  // namespace stipple
