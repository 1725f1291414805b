#include "apps/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace stipple {
namespace {

/// The word of the command line that stands for a subcommand and is none, or null. CLI11 says of it
/// only that a subcommand is missing.
const char* unknown_subcommand(CLI::App& app, std::span<char* const> words) {
    CLI::App* command = &app;
    for (const char* word : words) {
        const auto choices = command->get_subcommands({});
        if (choices.empty() || word[0] == '-') return nullptr;
        const auto chosen = std::ranges::find_if(
            choices, [&](const CLI::App* choice) { return choice->check_name(word); });
        if (chosen == choices.end()) return word;
        command = *chosen;
    }
    return nullptr;
}

}  // namespace

CommandOption& CommandOption::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

CommandOption& CommandOption::required() {
    option_->required();
    return *this;
}

CommandOption& CommandOption::check(const ValueCheck& check) {
    option_->check(check);
    return *this;
}

CommandOption& CommandOption::split_at_commas() {
    option_->delimiter(',');
    return *this;
}

CommandOption& CommandOption::one_of(const std::vector<std::string>& values) {
    option_->check(CLI::IsMember(values));
    return *this;
}

CommandOption& CommandOption::group(const std::string& heading) {
    option_->group(heading);
    return *this;
}

CommandOption& CommandOption::needs(const CommandOption& other) {
    option_->needs(other.option_);
    return *this;
}

CommandOption& CommandOption::excludes(const CommandOption& other) {
    option_->excludes(other.option_);
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& text) {
    app_->require_subcommand(1);
    return Command(*app_->add_subcommand(name, text));
}

void Command::footer(const std::string& text) {
    app_->footer(text);
}

void Command::callback(std::function<void()> action) {
    app_->callback(std::move(action));
}

template <typename Value>
CommandOption Command::add_option(const std::string& names, Value& value, const std::string& text) {
    return CommandOption(*app_->add_option(names, value, text));
}
using Text = const std::string&;
template CommandOption Command::add_option(Text, std::string&, Text);
template CommandOption Command::add_option(Text, std::filesystem::path&, Text);
template CommandOption Command::add_option(Text, int&, Text);
template CommandOption Command::add_option(Text, std::uint16_t&, Text);
template CommandOption Command::add_option(Text, std::int64_t&, Text);
template CommandOption Command::add_option(Text, std::uint64_t&, Text);
template CommandOption Command::add_option(Text, double&, Text);
template CommandOption Command::add_option(Text, std::optional<double>&, Text);
template CommandOption Command::add_option(Text, std::optional<std::uint64_t>&, Text);

CommandOption Command::add_parsed(const std::string& names, std::function<void(std::string)> take,
                                  const std::string& text) {
    return CommandOption(*app_->add_option_function<std::string>(names, take, text));
}

CommandOption Command::add_list(const std::string& names, std::vector<std::string>& values,
                                const std::string& text) {
    return CommandOption(*app_->add_option(names, values, text)->allow_extra_args(false));
}

CommandOption Command::add_flag(const std::string& names, bool& value, const std::string& text) {
    return CommandOption(*app_->add_flag(names, value, text));
}

CommandOption Command::add_flag(const std::string& names, std::string& value,
                                const std::string& text) {
    return CommandOption(*app_->add_flag(names, value, text));
}

CommandOption Command::add_flag(const std::string& names, std::function<void()> act,
                                const std::string& text) {
    return CommandOption(*app_->add_flag_callback(names, std::move(act), text));
}

CommandOption Command::option(const std::string& name) {
    return CommandOption(*app_->get_option(name));
}

void Command::refuse(const std::vector<std::string>& names, const std::string& why) const {
    for (const std::string& name : names)
        if (app_->count(name) > 0) throw UsageError(name, why);
}

std::vector<Command> Command::leaves() {
    const auto below = app_->get_subcommands({});
    if (below.empty()) return {*this};
    std::vector<Command> found;
    for (CLI::App* command : below)
        for (const Command& leaf : Command(*command).leaves()) found.push_back(leaf);
    return found;
}

CommandLine::CommandLine(const std::string& program, const std::string& text,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(text, program)) {
    if (!version.empty()) app_->set_version_flag("--version", program + ' ' + version);
}

CommandLine::~CommandLine() = default;

CommandLine::Parsed CommandLine::parse(int argc, char** argv) {
    if (const char* word = unknown_subcommand(*app_, {argv + 1, argv + argc})) {
        fmt::print(stderr, "stipple: there is no subcommand \"{}\"; --help lists them\n", word);
        return Parsed::kWrong;
    }
    try {
        try {
            app_->parse(argc, argv);
            return Parsed::kAction;
        } catch (const UsageError& e) {
            throw CLI::ValidationError(e.option(), e.what());
        }
    } catch (const CLI::ParseError& e) {
        return app_->exit(e) == 0 ? Parsed::kHelp : Parsed::kWrong;
    }
}

}  // namespace stipple
