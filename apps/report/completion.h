#pragma once

#include <string>
#include <string_view>

#include "apps/arguments/command_description.h"

namespace stipple {

/// The completion script for a shell: "bash", "zsh" or "fish". The shell completes names of files;
/// `stipple list` gives the names of sensors and schedules.
[[nodiscard]] std::string completion(const CommandDescription& program, std::string_view shell);

}  // namespace stipple
