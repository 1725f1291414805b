#pragma once

#include <string>
#include <string_view>

namespace stipple {

/// True if `text` is UTF-8 (RFC 3629: shortest form, no surrogates) without control characters
/// (U+0000..1F, U+007F..9F), so that it cannot control a terminal. With `lines` tab, LF and CR are
/// allowed.
[[nodiscard]] bool is_plain_text(std::string_view text, bool lines);

/// `text` in a form that cannot control a terminal, except for tabs and line feeds. Other control
/// characters, line and paragraph separators (U+2028, U+2029) and bidirectional controls
/// (U+202A..2E, U+2066..69) become "\u001b" and so on, as in JSON; bytes that are not UTF-8 become
/// "\xff".
[[nodiscard]] std::string terminal_text(std::string_view text);

}  // namespace stipple
