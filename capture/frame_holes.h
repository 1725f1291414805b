#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace stipple {

/// Writes a pattern of 8 random bytes over a buffer that a camera is to fill, so that
/// `clear_holes` finds what was not written.
void mark_unwritten(std::span<std::uint8_t> buffer) noexcept;

/// The same for the bytes from `begin` to before `end`, which lie in it.
void mark_unwritten(std::span<std::uint8_t> buffer, std::size_t begin, std::size_t end) noexcept;

/// Finds the bytes of `buffer` that still hold the pattern and sets them to 0. Runs of at least 15
/// bytes are found, and any run at the end; a pixel beside a hole that happens to equal the pattern
/// (1 in 256) counts as part of it. Returns [begin, end) of each, in order.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> clear_holes(
    std::span<std::uint8_t> buffer);

}  // namespace stipple
