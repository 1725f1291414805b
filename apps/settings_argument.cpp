#include "apps/settings_argument.h"

#include <fmt/format.h>

#include <utility>

#include "core/joined.h"

namespace stipple {

CommandOption add_settings(Command& command, std::vector<SettingsSection> sections,
                           const std::string& text) {
    std::vector<std::string> names;
    for (const SettingsSection& section : sections) names.push_back(section.name);
    const std::string type =
        fmt::format("{}.KEY=VALUE", names.size() == 1 ? names.front() : "SECTION");
    const auto take = [sections = std::move(sections), names](const std::string& setting) {
        for (const auto& [name, settings] : sections)
            if (setting.starts_with(name + "."))
                return settings->push_back(setting.substr(name.size() + 1));
        std::vector<std::string> prefixes;
        for (const std::string& name : names) prefixes.push_back(name + ".");
        throw UsageError(
            "--set", fmt::format("{}: its key begins with none of {}", setting, joined(prefixes)));
    };
    return command.add_list("--set", take, text).type_name(type);
}

}  // namespace stipple
