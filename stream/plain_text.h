#pragma once

#include <string_view>

namespace stipple {

/// True if `text` is UTF-8 (RFC 3629: shortest form, no surrogates) without control characters
/// (U+0000..1F, U+007F..9F), so that printing it does nothing to a terminal. With `lines` tab, LF
/// and CR are allowed.
[[nodiscard]] bool is_plain_text(std::string_view text, bool lines);

}  // namespace stipple
