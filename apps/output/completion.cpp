#include "apps/output/manual.h"

#include <fmt/format.h>

#include <vector>

namespace stipple {
namespace {

void list_commands(const CommandDescription& command, std::vector<const CommandDescription*>& all) {
    all.push_back(&command);
    for (const CommandDescription& below : command.commands) list_commands(below, all);
}

/// The command and those below it.
std::vector<const CommandDescription*> all_commands(const CommandDescription& program) {
    std::vector<const CommandDescription*> all;
    list_commands(program, all);
    return all;
}

std::string joined_by(const std::vector<std::string>& words, std::string_view separator) {
    return fmt::format("{}", fmt::join(words, separator));
}

/// The last word of a command's name.
std::string own_name(const CommandDescription& command) {
    return command.name.substr(command.name.rfind(' ') + 1);
}

/// In single quotes, for any of the shells: their only escape in common.
std::string in_quotes(std::string_view text) {
    std::string out = "'";
    for (const char character : text)
        out += character == '\'' ? "'\\''" : std::string(1, character);
    return out + "'";
}

/// "stipple emulate" | "stipple capture" | ...: the commands but the program.
std::string command_pattern(const CommandDescription& program) {
    std::vector<std::string> names;
    for (const CommandDescription* command : all_commands(program))
        if (command != &program) names.push_back('"' + command->name + '"');
    return joined_by(names, " | ");
}

// bash

/// The words that may stand for a value: named ones, or what `stipple list` prints.
std::string bash_values(const OptionDescription& option) {
    if (!option.list.empty())
        return fmt::format("$(stipple list {} 2> /dev/null | cut -d ' ' -f 1)", option.list);
    return joined_by(option.choices, " ");
}

std::string bash_case(const CommandDescription& command) {
    std::vector<std::string> words;
    for (const CommandDescription& below : command.commands) words.push_back(own_name(below));
    std::string values;
    for (const OptionDescription& option : command.options) {
        if (option.argument) {
            if (const auto known = bash_values(option); !known.empty()) words.push_back(known);
            continue;
        }
        words.insert(words.end(), option.names.begin(), option.names.end());
        if (!option.value.empty())
            values += fmt::format("                {}) words=\"{}\" ;;\n",
                                  joined_by(option.names, " | "), bash_values(option));
    }
    return fmt::format(
        "        \"{}\")\n            case $previous in\n{}"
        "                *) words=\"{}\" ;;\n            esac ;;\n",
        command.name, values, joined_by(words, " "));
}

std::string bash_completion(const CommandDescription& program) {
    std::string cases;
    for (const CommandDescription* command : all_commands(program)) cases += bash_case(*command);
    return fmt::format(
        "# bash completion of {0}\n"
        "_{0}() {{\n"
        "    local command={0} words= word previous=${{COMP_WORDS[COMP_CWORD - 1]}}\n"
        "    for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
        "        case \"$command $word\" in\n"
        "            {1}) command=\"$command $word\" ;;\n"
        "        esac\n"
        "    done\n"
        "    case $command in\n"
        "{2}"
        "    esac\n"
        "    mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"${{COMP_WORDS[COMP_CWORD]}}\")\n"
        "}}\n"
        "complete -o default -F _{0} {0}\n",
        program.name, command_pattern(program), cases);
}

// fish

std::string fish_values(const OptionDescription& option) {
    if (!option.list.empty())
        return fmt::format("(stipple list {} 2> /dev/null | string replace -r '  +' '\\t')",
                           option.list);
    return joined_by(option.choices, " ");
}

std::string fish_option(const OptionDescription& option) {
    std::string line;
    if (option.argument) {
        const auto values = fish_values(option);
        return values.empty()
                   ? ""
                   : fmt::format(" -a {} -d {}", in_quotes(values), in_quotes(option.text));
    }
    for (const std::string& name : option.names)
        line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    if (!option.value.empty()) line += option.choices.empty() ? " -r" : " -x";  // or no files
    if (const auto values = fish_values(option); !values.empty())
        line += " -a " + in_quotes(values);
    return line + " -d " + in_quotes(option.text);
}

std::string fish_completion(const CommandDescription& program) {
    std::string lines;
    for (const CommandDescription* command : all_commands(program)) {
        const auto add = [&](const std::string& what) {
            if (!what.empty())
                lines += fmt::format("complete -c {} -n '__{}_at \"{}\"'{}\n", program.name,
                                     program.name, command->name, what);
        };
        for (const CommandDescription& below : command->commands)
            add(fmt::format(" -f -a {} -d {}", own_name(below), in_quotes(below.text)));
        for (const OptionDescription& option : command->options) add(fish_option(option));
    }
    return fmt::format(
        "# fish completion of {0}\n"
        "function __{0}_at --description 'whether the command line names this command'\n"
        "    set -l command {0}\n"
        "    for word in (commandline -opc)[2..]\n"
        "        switch \"$command $word\"\n"
        "            case {1}\n"
        "                set command \"$command $word\"\n"
        "        end\n"
        "    end\n"
        "    test \"$command\" = $argv[1]\n"
        "end\n"
        "{2}",
        program.name,
        [&] {
            std::string names;
            for (const CommandDescription* command : all_commands(program))
                if (command != &program) names += fmt::format(" \"{}\"", command->name);
            return names.substr(1);
        }(),
        lines);
}

// zsh

/// Text in a specification of _arguments: brackets and colons have a meaning there.
std::string zsh_text(std::string_view text) {
    std::string out;
    for (const char character : text) {
        if (character == '[' || character == ']' || character == ':' || character == '\\')
            out += '\\';
        out += character;
    }
    return out;
}

std::string zsh_action(const OptionDescription& option) {
    if (!option.list.empty())
        return fmt::format(
            "{{compadd - $(stipple list {} 2> /dev/null | cut -d \" \" -f 1); _files}}",
            option.list);
    return option.choices.empty() ? "_files" : fmt::format("({})", joined_by(option.choices, " "));
}

std::string zsh_specification(const OptionDescription& option) {
    if (option.argument)
        return ' ' + in_quotes(fmt::format("{}:{}:{}", option.repeats ? "*" : "",
                                           zsh_text(option.names.front()), zsh_action(option)));
    std::string out;
    for (const std::string& name : option.names) {
        const std::string excluded =
            option.repeats ? "*" : fmt::format("({})", joined_by(option.names, " "));
        std::string word = fmt::format("{}{}[{}]", excluded, name, zsh_text(option.text));
        if (!option.value.empty())
            word += fmt::format(":{}:{}", zsh_text(option.value), zsh_action(option));
        out += ' ' + in_quotes(word);
    }
    return out;
}

std::string zsh_case(const CommandDescription& command) {
    std::string lines;
    if (!command.commands.empty()) {
        std::string commands;
        for (const CommandDescription& below : command.commands)
            commands += ' ' + in_quotes(own_name(below) + ':' + zsh_text(below.text));
        lines = fmt::format(
            "            local -a commands=({})\n"
            "            _describe command commands\n",
            commands.substr(1));
    }
    std::string options;
    for (const OptionDescription& option : command.options) options += zsh_specification(option);
    return fmt::format("        (\"{}\")\n{}            _arguments -s{} ;;\n", command.name, lines,
                       options);
}

std::string zsh_completion(const CommandDescription& program) {
    std::string cases;
    for (const CommandDescription* command : all_commands(program)) cases += zsh_case(*command);
    return fmt::format(
        "#compdef {0}\n"
        "_{0}() {{\n"
        "    local command={0} word\n"
        "    integer last=1 i\n"
        "    for (( i = 2; i < CURRENT; i++ )); do\n"
        "        case \"$command $words[i]\" in\n"
        "            ({1}) command=\"$command $words[i]\" last=i ;;\n"
        "        esac\n"
        "    done\n"
        "    words=(\"${{(@)words[last,-1]}}\")\n"
        "    (( CURRENT -= last - 1 ))\n"
        "    case $command in\n"
        "{2}"
        "    esac\n"
        "}}\n"
        "if [ \"$funcstack[1]\" = _{0} ]; then _{0} \"$@\"; else compdef _{0} {0}; fi\n",
        program.name, command_pattern(program), cases);
}

}  // namespace

std::string completion(const CommandDescription& program, std::string_view shell) {
    return shell == "fish"  ? fish_completion(program)
           : shell == "zsh" ? zsh_completion(program)
                            : bash_completion(program);
}

}  // namespace stipple
