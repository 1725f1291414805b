#pragma once

#include <string>
#include <vector>

#include "apps/arguments/command_line.h"

namespace stipple {

/// What `--set SECTION.KEY=VALUE` changes: "KEY=VALUE" is added to `settings`.
struct SettingsSection {
    std::string name;                    ///< "sensor"
    std::vector<std::string>* settings;  ///< outlives the parsing
};

/// `--set`, which may be given several times, for these sections. Parsing refuses others.
CommandOption add_settings(Command& command, std::vector<SettingsSection> sections,
                           const std::string& text);

}  // namespace stipple
