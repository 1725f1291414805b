#pragma once

#include <string>
#include <string_view>

#include "apps/arguments/command_description.h"

namespace stipple {

/// What completes the command line in a shell: "bash", "zsh" or "fish". Values of options that name
/// files are completed by the shell, those that `stipple list` knows by asking it.
[[nodiscard]] std::string completion(const CommandDescription& program, std::string_view shell);

}  // namespace stipple
