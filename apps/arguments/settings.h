#pragma once

#include <string>
#include <vector>

#include "apps/arguments/command_line.h"

namespace stipple {

/// A section of `--set SECTION.KEY=VALUE`: "KEY=VALUE" is appended to `settings`.
struct SettingsSection {
    std::string name;                    ///< "sensor"
    std::vector<std::string>* settings;  ///< outlives the parsing
};

/// `--set`, repeatable, for these sections. Parsing refuses other sections.
CommandOption add_settings(Command& command, std::vector<SettingsSection> sections,
                           const std::string& text);

}  // namespace stipple
