#pragma once

#include <cstddef>
#include <string>

namespace stipple {

/// `bytes` with one that differs, in the bits of `mask`.
[[nodiscard]] inline std::string flipped(std::string bytes, std::size_t at, int mask = 0x10) {
    bytes[at] = static_cast<char>(bytes[at] ^ mask);
    return bytes;
}

/// `bytes` without those from `begin` to before `end`.
[[nodiscard]] inline std::string without(std::string bytes, std::size_t begin, std::size_t end) {
    return bytes.erase(begin, end - begin);
}

}  // namespace stipple
