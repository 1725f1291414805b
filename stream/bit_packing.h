#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace stipple {

/// Bytes that `samples` samples of `bit_depth` bits fill.
[[nodiscard]] constexpr std::size_t packed_bytes(std::size_t samples, int bit_depth) {
    return (samples * static_cast<std::size_t>(bit_depth) + 7) / 8;
}

/// Packs DN of `bit_depth` (1..16) bits LSB first without gaps: bit k of the result is bit k % 8
/// of byte k / 8, sample i fills bits i * bit_depth and up, unused bits of the last byte are 0.
/// Preconditions: each DN < 2^bit_depth; packed.size() == packed_bytes(dn.size(), bit_depth).
void pack_bits(std::span<const std::uint16_t> dn, int bit_depth,
               std::span<std::uint8_t> packed) noexcept;

/// The inverse; the unused bits of the last byte are ignored. Same preconditions on sizes.
void unpack_bits(std::span<const std::uint8_t> packed, int bit_depth,
                 std::span<std::uint16_t> dn) noexcept;

}  // namespace stipple
