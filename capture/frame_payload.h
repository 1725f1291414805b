#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace stipple {

/// Fills a buffer with a pattern of 8 random bytes before a camera writes to it, so that
/// `clear_holes` finds the bytes that were not written.
void mark_unwritten(std::span<std::uint8_t> buffer) noexcept;

/// The same for bytes [begin, end) of the buffer. Precondition: they lie in it.
void mark_unwritten(std::span<std::uint8_t> buffer, std::size_t begin, std::size_t end) noexcept;

/// Finds the bytes of `buffer` that still hold the pattern (holes) and sets them to 0. Runs of at
/// least 15 bytes are found, and any run at the end. A pixel beside a hole that equals the pattern
/// by chance (1 in 256) counts as part of the hole. Returns [begin, end) of each hole, in order.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> clear_holes(
    std::span<std::uint8_t> buffer);

/// XXH3, 64 bit, seed 0: the hash of a frame's payload, and of a camera's XML description.
[[nodiscard]] std::uint64_t payload_hash(std::span<const std::uint8_t> payload);

}  // namespace stipple
