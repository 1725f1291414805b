#pragma once

#include <filesystem>
#include <string>

namespace stipple {

// What runs that were killed have left: partial outputs whose process is no longer there.

/// Says in a line on standard error that a run which was killed has left some of `output`, if so.
void say_leftover(const std::filesystem::path& output);

/// What the name of a file says beside its content: that a run is writing it, or was killed; empty
/// if it is no name of a partial output. Begins with "; ".
[[nodiscard]] std::string leftover_text(const std::filesystem::path& file);

}  // namespace stipple
