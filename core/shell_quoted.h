#pragma once

#include <string>

namespace stipple {

/// `argument` as a POSIX shell takes it for one word: as it is if all of its characters are plain,
/// else in single quotes.
[[nodiscard]] std::string shell_quoted(const std::string& argument);

}  // namespace stipple
