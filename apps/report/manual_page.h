#pragma once

#include <string>

#include "apps/arguments/command_description.h"

namespace stipple {

/// The manual page of a command in section 1, for man(7); `version` is the program's.
[[nodiscard]] std::string manual_page(const CommandDescription& command,
                                      const std::string& version);

/// "stipple-capture-record", the name of its page.
[[nodiscard]] std::string manual_page_name(const CommandDescription& command);

}  // namespace stipple
