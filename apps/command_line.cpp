#include "apps/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <system_error>

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

namespace fs = std::filesystem;

/// What the options given name, by the words of the command line.
std::vector<std::pair<std::string, fs::path>> named_files(
    const std::vector<CLI::Option*>& options) {
    std::vector<std::pair<std::string, fs::path>> files;
    for (const CLI::Option* option : options)
        for (const std::string& name : option->results())
            if (name != "-" && !name.empty()) files.emplace_back(option->get_name(), name);
    return files;
}

/// The file or folder that an input stands for: of a pattern the folder.
fs::path input_path(const fs::path& named) {
    constexpr std::string_view kReplay = "replay:";
    const std::string name = named.string();
    if (name.starts_with(kReplay)) return name.substr(kReplay.size());
    if (name.find('%') != std::string::npos && !fs::exists(named))
        return named.has_parent_path() ? named.parent_path() : ".";
    return named;
}

/// Whether two names lead to the same file or folder, or will. Devices and pipes may be shared.
bool same_file(const fs::path& a, const fs::path& b) {
    std::error_code error;
    const auto kind = fs::status(a, error).type();
    if (kind != fs::file_type::not_found && kind != fs::file_type::regular &&
        kind != fs::file_type::directory)
        return false;
    if (fs::equivalent(a, b, error)) return true;
    const auto place = [&](const fs::path& path) {
        const fs::path whole = fs::absolute(path, error).lexically_normal();
        return fs::weakly_canonical(whole.has_filename() ? whole : whole.parent_path(), error);
    };
    return place(a) == place(b);
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

CommandOption& CommandOption::input() {
    files_->inputs.push_back(option_);
    return *this;
}

CommandOption& CommandOption::output() {
    files_->outputs.push_back(option_);
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& text) {
    app_->require_subcommand(1);
    return {*app_->add_subcommand(name, text), *files_};
}

void Command::footer(const std::string& text) {
    app_->footer(text);
}

void Command::callback(std::function<void()> action) {
    app_->callback(std::move(action));
}

template <typename Value>
CommandOption Command::add_option(const std::string& names, Value& value, const std::string& text) {
    return handle(app_->add_option(names, value, text));
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
    const auto call = [take = std::move(take)](const std::string& value) { take(value); };
    return handle(app_->add_option_function<std::string>(names, call, text));
}

CommandOption Command::add_list(const std::string& names, std::vector<std::string>& values,
                                const std::string& text) {
    return handle(app_->add_option(names, values, text)->allow_extra_args(false));
}

CommandOption Command::add_flag(const std::string& names, bool& value, const std::string& text) {
    return handle(app_->add_flag(names, value, text));
}

CommandOption Command::add_flag(const std::string& names, std::string& value,
                                const std::string& text) {
    return handle(app_->add_flag(names, value, text));
}

CommandOption Command::add_flag(const std::string& names, std::function<void()> act,
                                const std::string& text) {
    return handle(app_->add_flag_callback(names, std::move(act), text));
}

CommandOption Command::option(const std::string& name) {
    return handle(app_->get_option(name));
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
        for (const Command& leaf : Command(*command, *files_).leaves()) found.push_back(leaf);
    return found;
}

CommandLine::CommandLine(const std::string& program, const std::string& text,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(text, program)) {
    if (!version.empty()) app_->set_version_flag("--version", program + ' ' + version);
}

CommandLine::~CommandLine() = default;

void CommandLine::check_files() const {
    const auto inputs = named_files(files_.inputs);
    const auto outputs = named_files(files_.outputs);
    for (auto output = outputs.begin(); output != outputs.end(); ++output) {
        for (const auto& [option, input] : inputs)
            // What is no file is the name of a sensor or schedule.
            if (std::error_code error; fs::exists(input_path(input), error) &&
                                       same_file(output->second, input_path(input)))
                throw UsageError(output->first,
                                 fmt::format("{} is what {} reads; give the output another name",
                                             output->second.string(), option));
        for (auto other = outputs.begin(); other != output; ++other)
            if (same_file(output->second, other->second))
                throw UsageError(
                    output->first,
                    fmt::format("{} is the output of {} too; give one of them another name",
                                output->second.string(), other->first));
    }
}

CommandLine::Parsed CommandLine::parse(int argc, char** argv) {
    try {
        if (const char* word = unknown_subcommand(*app_, {argv + 1, argv + argc}))
            throw CLI::ValidationError(
                fmt::format("there is no subcommand \"{}\"; --help lists them", word));
        try {
            app_->parse(argc, argv);
            check_files();
            return Parsed::kAction;
        } catch (const UsageError& e) {
            throw CLI::ValidationError(e.option(), e.what());
        }
    } catch (const CLI::ParseError& e) {
        return app_->exit(e) == 0 ? Parsed::kHelp : Parsed::kWrong;
    }
}

}  // namespace stipple
