#pragma once

#include <string>
#include <string_view>

namespace stipple {

/// True if `text` is UTF-8 (RFC 3629: shortest form, no surrogates) without control characters
/// (U+0000..1F, U+007F..9F), so that printing it does nothing to a terminal. With `lines` tab, LF
/// and CR are allowed.
[[nodiscard]] bool is_plain_text(std::string_view text, bool lines);

/// `text` so that showing it does nothing to a terminal but begin lines and advance to tab stops:
/// other control characters, and those that begin lines (U+2028, U+2029) or turn the direction of
/// text (U+202A..2E, U+2066..69), become "\u001b" and so on, as in JSON; bytes that are no UTF-8
/// "\xff".
[[nodiscard]] std::string terminal_text(std::string_view text);

}  // namespace stipple
