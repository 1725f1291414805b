#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

// GigE Vision is big-endian on the wire.

/// The number in the first sizeof(T) bytes, which must be readable.
template <std::unsigned_integral T>
[[nodiscard]] constexpr T load_be(const std::uint8_t* bytes) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        value = static_cast<T>(static_cast<std::uint64_t>(value) << 8U | bytes[i]);
    return value;
}

/// Precondition: sizeof(T) bytes are writable.
template <std::unsigned_integral T>
constexpr void store_be(std::uint8_t* bytes, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
        bytes[i] = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >>
                                             (8 * (sizeof(T) - 1 - i)));
}

template <std::unsigned_integral T>
void append_be(std::vector<std::uint8_t>& bytes, T value) {
    bytes.resize(bytes.size() + sizeof(T));
    store_be(&bytes[bytes.size() - sizeof(T)], value);
}

}  // namespace stipple
