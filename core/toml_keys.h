#pragma once

#include <cstddef>
#include <string_view>

namespace stipple {

/// Max parts of a key or of a table name, as in "a.b.c".
inline constexpr std::size_t kMaxKeyParts = 32;

/// The line (from 1) of the first key in TOML text with more parts than that; 0 if there is none.
/// Parser and destructors recurse once per part, so a long key would overflow the stack.
[[nodiscard]] std::size_t line_of_long_key(std::string_view toml);

}  // namespace stipple
