#pragma once

#include <string>
#include <string_view>

#include "apps/arguments/command_description.h"

namespace stipple {

/// The completion script for a shell: "bash", "zsh" or "fish". The shell completes names of files;
/// `stipple list` gives the names of sensors and schedules.
[[nodiscard]] std::string completion(const CommandDescription& program, std::string_view shell);

/// The manual page of a command in section 1, for man(7); `version` is the program's.
[[nodiscard]] std::string manual_page(const CommandDescription& command,
                                      const std::string& version);

/// "stipple-capture-record", the name of its page.
[[nodiscard]] std::string manual_page_name(const CommandDescription& command);

/// The command line of a command as Markdown: its synopsis, and tables of its commands and
/// options. The options that all commands share are in the page of the program alone, and --help
/// is in none.
[[nodiscard]] std::string markdown_page(const CommandDescription& command);

}  // namespace stipple
