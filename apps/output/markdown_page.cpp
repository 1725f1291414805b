#include "apps/output/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "core/text.h"

namespace stipple {
namespace {

constexpr std::string_view kPlainOptions = "Options";  // CLI11's heading of all others

/// Text of a cell of a table: `|` would end it, `<` begin a tag.
std::string cell(std::string_view text) {
    std::string out;
    for (const char character : text) {
        if (character == '|' || character == '<') out += '\\';
        out += character;
    }
    return out;
}

/// --flag[=VALUE], whose text tells the value.
bool has_optional_value(const OptionDescription& option) {
    return option.value.starts_with('[');
}

/// `-o`, `--output FILE`
std::string tag_of(const OptionDescription& option) {
    std::string names;
    for (const std::string& name : option.names)
        names += fmt::format("{}`{}", names.empty() ? "" : "`, ", name);
    if (has_optional_value(option)) return cell(names + option.value + '`');
    return cell(fmt::format("{}{}{}`", names, option.value.empty() ? "" : " ", option.value));
}

std::string meaning_of(const OptionDescription& option) {
    std::string text = option.text;
    if (!option.choices.empty() && !has_optional_value(option))
        text += fmt::format("; one of {}", joined(option.choices));
    if (option.required) text += "; required";
    if (option.repeats) text += "; may be repeated";
    return cell(text);
}

/// The options under one heading; empty if there are none.
std::string table_of(std::string_view heading, const std::vector<OptionDescription>& options) {
    if (options.empty()) return {};
    std::string table = fmt::format("\n| {} | meaning |\n|---|---|\n",
                                    heading == kPlainOptions ? "option" : heading);
    for (const OptionDescription& option : options)
        table += fmt::format("| {} | {} |\n", tag_of(option), meaning_of(option));
    return table;
}

/// The options that all commands share, taken from the first command without subcommands.
std::vector<OptionDescription> common_options(const CommandDescription& command) {
    if (!command.commands.empty()) return common_options(command.commands.front());
    std::vector<OptionDescription> common;
    std::ranges::copy_if(
        command.options, std::back_inserter(common),
        [](const OptionDescription& option) { return option.group == kCommonOptions; });
    return common;
}

/// Headings in the order of the help, without that of the common options.
std::vector<std::string> headings_of(const CommandDescription& command) {
    std::vector<std::string> headings;
    for (const OptionDescription& option : command.options)
        if (option.group != kCommonOptions && std::ranges::count(headings, option.group) == 0)
            headings.push_back(option.group);
    return headings;
}

std::string options_of(const CommandDescription& command) {
    std::string tables;
    for (const std::string& heading : headings_of(command)) {
        std::vector<OptionDescription> options;
        for (const OptionDescription& option : command.options)
            if (option.group == heading && std::ranges::count(option.names, "--help") == 0)
                options.push_back(option);
        tables += table_of(heading, options);
    }
    return tables;
}

std::string synopsis_of(const CommandDescription& command) {
    if (!command.commands.empty()) return fmt::format("`{} COMMAND ...`\n", command.name);
    std::string line = command.name;
    for (const OptionDescription& option : command.options) {
        const std::string& name = option.names.front();
        if (option.argument) line += option.required ? " " + name : fmt::format(" [{}]", name);
    }
    for (const OptionDescription& option : command.options)
        if (option.required && !option.argument)
            line += fmt::format(" {} {}", option.names.front(), option.value);
    return fmt::format("`{} [OPTION]...`\n", line);
}

std::string commands_of(const CommandDescription& command) {
    if (command.commands.empty()) return {};
    std::string table = "\n| command | task |\n|---|---|\n";
    for (const CommandDescription& below : command.commands)
        table += fmt::format("| `{}` | {} |\n", below.name, cell(below.text));
    return table;
}

}  // namespace

std::string markdown_page(const CommandDescription& command) {
    const bool is_program = command.name.find(' ') == std::string::npos;
    std::string page = synopsis_of(command) + commands_of(command) + options_of(command);
    if (is_program) page += table_of(kCommonOptions, common_options(command));
    return page;
}

}  // namespace stipple
