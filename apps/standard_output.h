#pragma once

#include <string_view>

namespace stipple {

/// Writes text to standard output. \throws std::system_error at "standard output" if it cannot be
/// written.
void print_text(std::string_view text);

}  // namespace stipple
