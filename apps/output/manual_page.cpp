#include "apps/output/manual.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string_view>

#include "core/text.h"

namespace stipple {
namespace {

/// Text as roff prints it: no escapes, no requests at the beginning of a line, dashes to copy.
std::string roff(std::string_view text) {
    std::string out;
    for (const char character : text) {
        const bool begins = out.empty() || out.back() == '\n';
        if (begins && (character == '.' || character == '\'')) out += "\\&";
        if (character == '\\') {
            out += "\\e";
        } else if (character == '-') {
            out += "\\-";
        } else {
            out += character;
        }
    }
    return out;
}

/// `-o`, `--output` FILE
std::string tag_of(const OptionDescription& option) {
    std::string names;
    for (const std::string& name : option.names)
        names += fmt::format("{}\\fB{}\\fR", names.empty() ? "" : ", ", roff(name));
    if (!option.value.empty()) names += fmt::format(" \\fI{}\\fR", roff(option.value));
    return names;
}

std::string entry_of(const OptionDescription& option) {
    std::string text = roff(option.text);
    if (!option.choices.empty()) text += fmt::format("; one of: {}", roff(joined(option.choices)));
    if (option.required && !option.argument) text += "; required";
    if (option.repeats) text += "; may be repeated";
    return fmt::format(".TP\n{}\n{}\n", tag_of(option), text);
}

std::string synopsis_of(const CommandDescription& command) {
    std::string line = fmt::format("\\fB{}\\fR", roff(command.name));
    if (!command.commands.empty()) return line + " \\fICOMMAND\\fR ...";
    line += " [\\fIOPTION\\fR]...";
    for (const OptionDescription& option : command.options) {
        if (!option.argument) continue;
        const std::string name = fmt::format("\\fI{}\\fR", roff(option.names.front()));
        line += option.required ? " " + name : fmt::format(" [{}]", name);
        if (option.repeats) line += "...";
    }
    return line;
}

std::string section(std::string_view heading, const std::string& body) {
    return body.empty() ? "" : fmt::format(".SH {}\n{}", heading, body);
}

std::string options_of(const CommandDescription& command, bool arguments) {
    std::string entries;
    for (const OptionDescription& option : command.options)
        if (option.argument == arguments) entries += entry_of(option);
    return entries;
}

/// The text below the help: examples line by line, the rest as a paragraph.
std::string examples_of(const std::string& footer) {
    std::string examples;
    std::istringstream lines(footer);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("  ")) examples += roff(line.substr(2)) + "\n";
    return examples.empty() ? "" : ".nf\n" + examples + ".fi\n";
}

constexpr auto kExitStatus =
    ".TP\n0\ndone\n.TP\n1\nan input cannot be used\n.TP\n2\nwrong command line\n"
    ".TP\n3\nan output or a device failed\n"
    ".TP\n130, 143\nstopped by Ctrl\\-C or SIGTERM; outputs are complete files of fewer frames\n";

}  // namespace

std::string manual_page_name(const CommandDescription& command) {
    std::string name = command.name;
    std::ranges::replace(name, ' ', '-');
    return name;
}

std::string manual_page(const CommandDescription& command, const std::string& version) {
    std::string title = manual_page_name(command);
    std::string commands;
    for (const CommandDescription& below : command.commands)
        commands +=
            fmt::format(".TP\n.BR {} (1)\n{}\n", roff(manual_page_name(below)), roff(below.text));
    std::string page = fmt::format(
        ".TH {} 1 \"\" \"stipple {}\" \"Stipple\"\n",
        [title]() mutable {
            for (char& letter : title) letter = static_cast<char>(std::toupper(letter));
            return roff(title);
        }(),
        version);
    page += section("NAME", fmt::format("{} \\- {}\n", roff(title), roff(command.text)));
    page += section("SYNOPSIS", synopsis_of(command) + "\n");
    page += section("COMMANDS", commands);
    page += section("ARGUMENTS", options_of(command, true));
    page += section("OPTIONS", options_of(command, false));
    page += section("EXIT STATUS", kExitStatus);
    page += section("EXAMPLES", examples_of(command.footer));
    if (const auto end = command.name.rfind(' '); end != std::string::npos) {
        std::string parent = command.name.substr(0, end);
        std::ranges::replace(parent, ' ', '-');
        page += section("SEE ALSO", fmt::format(".BR {} (1)\n", roff(parent)));
    }
    return page;
}

}  // namespace stipple
