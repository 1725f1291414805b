#include "apps/arguments/settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace stipple {

CommandOption add_settings(Command& command, std::vector<SettingsSection> sections,
                           const std::string& text) {
    const std::string type =
        fmt::format("{}.KEY=VALUE", sections.size() == 1 ? sections.front().name : "SECTION");
    const bool listed = std::ranges::any_of(
        sections, [](const SettingsSection& section) { return section.name != "camera"; });
    const auto take = [sections = std::move(sections)](const std::string& setting) {
        std::string prefixes;
        for (const auto& [name, settings] : sections) {
            if (setting.starts_with(name + "."))
                return settings->push_back(setting.substr(name.size() + 1));
            prefixes += fmt::format("{}{}.", prefixes.empty() ? "" : ", ", name);
        }
        throw UsageError("--set",
                         fmt::format("{}: its key begins with none of {}", setting, prefixes));
    };
    return command.add_list("--set", take, text + (listed ? " (stipple list keys)" : ""))
        .type_name(type);
}

}  // namespace stipple
