#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// CRC-32C (Castagnoli), as in RFC 3720. `previous` continues the CRC of the bytes before.
/// Uses the SSE4.2 instruction where the machine has it.
[[nodiscard]] std::uint32_t crc32c(std::span<const std::uint8_t> bytes, std::uint32_t previous = 0);

/// The same, by tables: the reference for the instruction.
[[nodiscard]] std::uint32_t crc32c_portable(std::span<const std::uint8_t> bytes,
                                            std::uint32_t previous = 0);

}  // namespace stipple
