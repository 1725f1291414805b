#pragma once

#include <string>

#include "apps/arguments/command_description.h"

namespace stipple {

/// The command line of a command as Markdown: its synopsis, and tables of its commands and
/// options. The options that all commands share are in the page of the program alone, and --help
/// is in none.
[[nodiscard]] std::string markdown_page(const CommandDescription& command);

}  // namespace stipple
