#include "apps/arguments/usage_problem.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <vector>

#include "core/text.h"
#include "io/image_file.h"

namespace stipple {
namespace {

std::vector<std::string> subcommands_of(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* choice : command.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(choice->get_name());
    return names;
}

/// The program and the subcommands that were named, from the outermost on.
std::vector<const CLI::App*> named_commands(const CLI::App& program) {
    std::vector<const CLI::App*> commands{&program};
    for (auto below = program.get_subcommands(); !below.empty();
         below = commands.back()->get_subcommands())
        commands.push_back(below.back());
    return commands;
}

/// "stipple capture list".
std::string name_of(std::span<const CLI::App* const> commands) {
    std::string name;
    for (const CLI::App* command : commands)
        name += (name.empty() ? "" : " ") + command->get_name();
    return name;
}

/// The option that was probably meant, or an empty text.
std::string nearest_option(const CLI::App& command, const std::string& word) {
    if (!word.starts_with("--")) return {};  // one letter is like any other
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back(name);
    const std::string nearest = nearest_name(word.substr(2), known);
    return nearest.empty() ? "" : "--" + nearest;
}

std::string option_problem(const std::vector<const CLI::App*>& commands, const CLI::App* command,
                           const std::string& word) {
    const std::string name = word.substr(0, word.find('='));
    const auto end = std::ranges::find(commands, command) + 1;
    const std::string problem =
        fmt::format("{} is not an option of {}", name, name_of({commands.begin(), end}));
    if (command != commands.back() && commands.back()->get_option_no_throw(name) != nullptr)
        return fmt::format("{}; write it behind \"{}\"", problem, name_of(commands));
    const std::string nearest = nearest_option(*command, name);
    return nearest.empty() ? problem : fmt::format("{}; did you mean {}?", problem, nearest);
}

/// The message for a surplus word. A shell that expands a pattern is the usual cause.
std::string surplus_problem(const std::vector<const CLI::App*>& commands, const std::string& word) {
    std::string problem = fmt::format("\"{}\" is more than {} takes", word, name_of(commands));
    std::error_code error;
    if (!std::filesystem::is_regular_file(word, error)) return problem;
    return problem + (image_reader(word) == nullptr
                          ? "; run it once for each file"
                          : "; for many images, name their folder or a pattern as frames/%04d.png");
}

/// The message for words that no command takes; empty if there are none.
std::string leftover_problem(const std::vector<const CLI::App*>& commands) {
    std::string surplus;
    for (const CLI::App* command : commands) {
        bool options_end = false;
        for (const std::string& word : command->remaining()) {
            if (word == "--") {
                options_end = true;
            } else if (word.size() > 1 && word[0] == '-') {
                if (!options_end) return option_problem(commands, command, word);
                if (surplus.empty())
                    surplus = fmt::format("\"{}\" is not an option behind \"--\"", word);
            } else if (surplus.empty()) {
                surplus = surplus_problem(commands, word);
            }
        }
    }
    return surplus;
}

/// An option that was given too often, or without its value.
std::string count_problem(const CLI::App& command, const std::string& last_word) {
    for (const CLI::Option* option : command.get_options()) {
        const auto count = static_cast<int>(option->count());
        const int max_count = option->get_items_expected_max();  // of flags 0
        if (max_count > 0 && count > max_count)
            return fmt::format("{} is given {} times; give it once", option->get_name(), count);
    }
    const CLI::Option* last = command.get_option_no_throw(last_word);
    return last == nullptr ? "" : fmt::format("{} needs a value", last->get_name());
}

std::string problem_of(const std::vector<const CLI::App*>& commands,
                       std::span<const std::string> words, const CLI::ParseError& error) {
    const CLI::App& command = *commands.back();
    if (std::string problem = leftover_problem(commands); !problem.empty()) return problem;
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
        if (std::string problem = count_problem(command, words.back()); !problem.empty())
            return problem;
    const auto choices = subcommands_of(command);
    if (!choices.empty() && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return fmt::format("\"{}\" needs a subcommand: {}", name_of(commands), joined(choices));
    return error.what();
}

}  // namespace

std::string unknown_subcommand(const CLI::App& program, std::span<const std::string> words) {
    const CLI::App* command = &program;
    for (const std::string& word : words) {
        const auto choices = subcommands_of(*command);
        if (choices.empty() || word.starts_with('-')) break;
        if (std::ranges::find(choices, word) == choices.end())
            return fmt::format("there is no subcommand \"{}\"; {}", word,
                               suggestion(word, choices));
        command = command->get_subcommand(word);
    }
    return {};
}

std::string usage_problem(const CLI::App& program, std::span<const std::string> words,
                          const CLI::ParseError& error) {
    const auto commands = named_commands(program);
    return fmt::format("{}\nsee \"{} --help\" for details", problem_of(commands, words, error),
                       name_of(commands));
}

}  // namespace stipple
