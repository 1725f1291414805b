#pragma once

#include <string>

namespace stipple {

/// The command line of this process, quoted for a shell, "stipple" as its program; empty if the
/// system does not tell it.
[[nodiscard]] std::string own_command();

}  // namespace stipple
