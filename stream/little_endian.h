#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <vector>

namespace stipple {

// The stream is little-endian; so are all machines that Stipple is built for.
static_assert(std::endian::native == std::endian::little);

template <typename T>
concept Stored = std::unsigned_integral<T> || std::same_as<T, float> || std::same_as<T, double>;

/// The number stored at `bytes`. Precondition: sizeof(T) bytes are readable.
template <Stored T>
[[nodiscard]] T load(const std::uint8_t* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}

/// Precondition: sizeof(T) bytes are writable.
template <Stored T>
void store(std::uint8_t* bytes, T value) {
    std::memcpy(bytes, &value, sizeof(T));
}

template <Stored T>
void append(std::vector<std::uint8_t>& bytes, T value) {
    bytes.resize(bytes.size() + sizeof(T));
    store(bytes.data() + bytes.size() - sizeof(T), value);
}

}  // namespace stipple
