#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// XXH3, 64 bit, seed 0: the hash of a frame's payload, and of a camera's XML description.
[[nodiscard]] std::uint64_t payload_hash(std::span<const std::uint8_t> payload);

}  // namespace stipple
