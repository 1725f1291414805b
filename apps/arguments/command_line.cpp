#include "apps/arguments/command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include "apps/arguments/usage_problem.h"
#include "apps/standard_streams.h"
#include "capture/recording/replay_camera.h"
#include "core/text.h"

namespace stipple {
namespace {

namespace fs = std::filesystem;

/// The words, with --help for "help" or "manual" in front of subcommands, or "help" alone behind
/// one.
std::vector<std::string> with_help(const CLI::App& program, std::vector<std::string> words) {
    const auto is_command = [&](const std::string& word) {
        return !program
                    .get_subcommands(
                        [&](const CLI::App* choice) { return choice->check_name(word); })
                    .empty();
    };
    const bool asks_manual = words.size() > 1 && words[0] == "manual" && is_command(words[1]);
    if (asks_manual || (!words.empty() && words.front() == "help")) {
        words.erase(words.begin());
        words.emplace_back("--help");
    }
    const CLI::App* command = &program;
    for (std::string& word : words) {
        const auto named = command->get_subcommands(
            [&](const CLI::App* choice) { return choice->check_name(word); });
        if (named.empty() && word == "help" && &word == &words.back()) word = "--help";
        if (named.empty()) break;
        command = named.front();
    }
    return words;
}

/// The files and folders that the given options name, each with the name of its option.
std::vector<std::pair<std::string, fs::path>> named_files(
    const std::vector<CLI::Option*>& options) {
    std::vector<std::pair<std::string, fs::path>> files;
    for (const CLI::Option* option : options)
        for (const std::string& name : option->results())
            if (name != "-") files.emplace_back(option->get_name(), name);
    return files;
}

/// The options whose output is standard output.
std::vector<std::string> written_to_standard_output(const DeclaredOptions& declared) {
    std::vector<std::string> names;
    for (const CLI::Option* option : declared.outputs)
        if (std::ranges::count(option->results(), "-") > 0) names.push_back(option->get_name());
    return names;
}

/// \throws UsageError for an empty name or "-" as the name of a file.
void check_names(const DeclaredOptions& declared) {
    const auto check = [](const CLI::Option* option, const char* standard_stream) {
        for (const std::string& name : option->results()) {
            if (name.empty()) throw UsageError(option->get_name(), "is empty; name a file");
            if (name == "-" && standard_stream != nullptr)
                throw UsageError(option->get_name(), standard_stream);
        }
    };
    for (const CLI::Option* option : declared.inputs)
        check(option, "\"-\" is not a file; write /dev/stdin where a stream comes from a pipe");
    for (std::size_t i = 0; i < declared.outputs.size(); ++i)
        check(declared.outputs[i], declared.output_names[i].may_be_pipe
                                       ? nullptr
                                       : "\"-\" is not a file; standard output does not take it, "
                                         "give it a name");
    if (const auto names = written_to_standard_output(declared); names.size() > 1)
        throw UsageError(
            names[0],
            fmt::format("\"-\" is the output of {} too; give one of them a name", names[1]));
}

/// The file or folder that an input stands for: of a pattern the folder.
fs::path input_path(const fs::path& named) {
    const std::string name = named.string();
    if (const auto file = replayed_file(name); !file.empty()) return file;
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
    const auto where = [&](const fs::path& path) {
        const fs::path whole = fs::absolute(path, error).lexically_normal();
        return fs::weakly_canonical(whole.has_filename() ? whole : whole.parent_path(), error);
    };
    return where(a) == where(b);
}

OptionDescription described(const CLI::Option& option, const DeclaredOptions& declared) {
    OptionDescription out;
    for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
    out.argument = option.get_positional();
    if (out.argument) out.names.push_back(option.get_name());
    if (!out.argument && option.get_type_size() > 0) out.value = option.get_type_name();
    out.text = option.get_description();
    out.group = option.get_group();
    out.required = option.get_required();
    out.repeats = option.get_items_expected_max() > 1;
    if (const auto values = declared.values.find(&option); values != declared.values.end()) {
        out.choices = values->second.choices;
        out.list = values->second.list;
    }
    return out;
}

CommandDescription described(const CLI::App& app, const std::string& before,
                             const DeclaredOptions& declared) {
    CommandDescription out{
        before + app.get_name(), app.get_description(), app.get_footer(), {}, {}};
    for (const CLI::Option* option : app.get_options())
        out.options.push_back(described(*option, declared));
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        out.commands.push_back(described(*command, out.name + " ", declared));
    return out;
}

}  // namespace

void check_extension(const std::string& option, const std::string& file, const OutputName& name) {
    if (const std::string problem = name_problem(file, name); !problem.empty())
        throw UsageError(option, fmt::format("{}: {}", file, problem));
}

CommandOption& CommandOption::type_name(const std::string& name) {
    option_->type_name(name);
    return *this;
}

CommandOption& CommandOption::required() {
    option_->required();
    return *this;
}

CommandOption& CommandOption::shows_default() {
    const std::string value = option_->capture_default_str()->get_default_str();
    option_->default_str({});  // CLI11 would print it a second time
    return default_text(value);
}

CommandOption& CommandOption::default_text(const std::string& text) {
    option_->description(fmt::format("{} (default: {})", option_->get_description(), text));
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
    declared_->values[option_].choices = values;
    option_->check([values](const std::string& value) {
        return std::ranges::find(values, value) != values.end()
                   ? std::string()
                   : fmt::format("\"{}\" is unknown; {}", value, suggestion(value, values));
    });
    return *this;
}

CommandOption& CommandOption::listed(const std::string& list) {
    declared_->values[option_].list = list;
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
    declared_->inputs.push_back(option_);
    return *this;
}

CommandOption& CommandOption::output(const OutputName& name) {
    declared_->outputs.push_back(option_);
    declared_->output_names.push_back(name);
    return *this;
}

Command Command::add_command(const std::string& name, const std::string& text) {
    app_->require_subcommand(1);
    return {*app_->add_subcommand(name, text), *declared_};
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
template CommandOption Command::add_option(Text, std::vector<std::string>&, Text);
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

CommandOption Command::add_list(const std::string& names, std::function<void(std::string)> take,
                                const std::string& text) {
    const auto call = [take = std::move(take)](const std::vector<std::string>& values) {
        for (const std::string& value : values) take(value);
    };
    return handle(app_->add_option_function<std::vector<std::string>>(names, call, text)
                      ->allow_extra_args(false));
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
        for (const Command& leaf : Command(*command, *declared_).leaves()) found.push_back(leaf);
    return found;
}

CommandLine::CommandLine(const std::string& program, const std::string& text,
                         const std::string& version)
    : app_(std::make_unique<CLI::App>(text, program)) {
    if (!version.empty()) app_->set_version_flag("-V,--version", program + ' ' + version);
}

CommandLine::~CommandLine() = default;

bool CommandLine::writes_to_standard_output() const {
    return !written_to_standard_output(declared_).empty();
}

CommandDescription CommandLine::description() const {
    return described(*app_, {}, declared_);
}

void CommandLine::check_files() const {
    check_names(declared_);
    const auto inputs = named_files(declared_.inputs);
    const auto outputs = named_files(declared_.outputs);
    for (auto output = outputs.begin(); output != outputs.end(); ++output) {
        for (const auto& [option, input] : inputs)
            // An input that does not exist as a file is the name of a sensor or schedule.
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
    for (std::size_t i = 0; i < declared_.outputs.size(); ++i)
        for (const std::string& file : declared_.outputs[i]->results())
            check_extension(declared_.outputs[i]->get_name(), file, declared_.output_names[i]);
}

CommandLine::Parsed CommandLine::parse(int argc, char** argv) {
    const std::vector<std::string> words = with_help(*app_, {argv + 1, argv + argc});
    try {
        if (const auto problem = unknown_subcommand(*app_, words); !problem.empty())
            throw CLI::ValidationError(problem);
        try {
            app_->parse(std::vector(words.rbegin(), words.rend()));  // as CLI11 wants them
            check_files();
            return Parsed::kAction;
        } catch (const UsageError& e) {
            throw CLI::ValidationError(e.option(), e.what());
        }
    } catch (const CLI::CallForHelp&) {
        print_text(app_->help());
    } catch (const CLI::CallForVersion& version) {
        print_text(version.what() + std::string("\n"));
    } catch (const CLI::ParseError& e) {
        say_error(usage_problem(*app_, words, e));
        return Parsed::kWrong;
    }
    return Parsed::kHelp;
}

}  // namespace stipple
