#pragma once

#include <cstddef>
#include <string_view>

namespace stipple {

/// The most parts of a key or of the name of a table, as in "a.b.c".
inline constexpr std::size_t kMaxKeyParts = 32;

/// The line (from 1) of the first key in TOML text that has more parts; 0 if none has. The parser
/// calls itself for each part, and so do the destructors of what it makes, so a long key would take
/// the whole stack.
[[nodiscard]] std::size_t line_of_long_key(std::string_view toml);

}  // namespace stipple
