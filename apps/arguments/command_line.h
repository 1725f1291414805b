#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apps/arguments/command_description.h"
#include "core/named_value.h"
#include "io/output_names.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace stipple {

// The command line as the subcommands see it. CLI11 stays inside command_line.cpp: it costs each
// source that includes it several seconds to compile.

/// The problem of a value, or an empty text.
using ValueCheck = std::function<std::string(const std::string&)>;

/// A wrong command line: exit code 2. Thrown by callbacks and by options that parse their value
/// themselves.
class UsageError : public std::runtime_error {
  public:
    UsageError(std::string option, const std::string& problem)
        : std::runtime_error(problem), option_(std::move(option)) {}
    /// The option that is wrong.
    [[nodiscard]] const std::string& option() const { return option_; }

  private:
    std::string option_;
};

/// \throws UsageError naming `option` if `file` has no name of `name`. An existing folder, pipe or
/// device may have any name.
void check_extension(const std::string& option, const std::string& file, const OutputName& name);

/// The values that an option takes.
struct OptionValues {
    std::vector<std::string> choices;  ///< all of them, if they have names
    std::string list;                  ///< of `stipple list`, or empty
};

/// Properties of the options of a command line that CLI11 does not know.
struct DeclaredOptions {
    std::vector<CLI::Option*> inputs;
    std::vector<CLI::Option*> outputs;
    std::vector<OutputName> output_names;  ///< of each output
    std::map<const CLI::Option*, OptionValues> values;
};

/// An option or a positional argument while it is declared.
class CommandOption {
  public:
    CommandOption(CLI::Option& option, DeclaredOptions& declared)
        : option_(&option), declared_(&declared) {}

    CommandOption& type_name(const std::string& name);
    CommandOption& required();
    /// Ends the help with the value that the variable of the option has now: "(default: 16)".
    CommandOption& shows_default();
    /// Ends the help with this default, for one that no variable holds: "all frames".
    CommandOption& default_text(const std::string& text);
    CommandOption& check(const ValueCheck& check);
    /// Of a list: one value may hold several, "a,b".
    CommandOption& split_at_commas();
    CommandOption& one_of(const std::vector<std::string>& values);
    /// It takes the names that `stipple list LIST` prints, for one.
    CommandOption& listed(const std::string& list);
    /// The heading of the help under which it stands.
    CommandOption& group(const std::string& heading);
    CommandOption& needs(const CommandOption& other);
    CommandOption& excludes(const CommandOption& other);
    /// Its value is an input: a file, a folder, a pattern or "replay:FILE".
    CommandOption& input();
    /// Its value is an output. Parsing refuses an output that is an input or another output, or
    /// that has no name of `name`.
    CommandOption& output(const OutputName& name = {});

  private:
    CLI::Option* option_;
    DeclaredOptions* declared_;
};

/// A subcommand. Copies stand for the same one. The variables of options must outlive the parsing.
class Command {
  public:
    Command(CLI::App& app, DeclaredOptions& declared) : app_(&app), declared_(&declared) {}

    /// A subcommand of this one, which then asks for one of them.
    [[nodiscard]] Command add_command(const std::string& name, const std::string& text);
    /// Text below the options.
    void footer(const std::string& text);
    /// Runs after parsing, if the command line names this subcommand.
    void callback(std::function<void()> action);

    /// `names` as "-o,--output", without a dash a positional argument. Values are texts, paths and
    /// numbers, or for the last argument a list of texts: those that command_line.cpp lists.
    template <typename Value>
    CommandOption add_option(const std::string& names, Value& value, const std::string& text);
    /// An option that parses its value itself.
    CommandOption add_parsed(const std::string& names, std::function<void(std::string)> take,
                             const std::string& text);
    /// An option that may be given several times, with one value each.
    CommandOption add_list(const std::string& names, std::vector<std::string>& values,
                           const std::string& text);
    /// The same, for values that `take` parses. `take` may throw UsageError.
    CommandOption add_list(const std::string& names, std::function<void(std::string)> take,
                           const std::string& text);
    /// An option that is a name of a value. The help ends with the name of the present value.
    template <typename Value>
    CommandOption add_choice(const std::string& names, Value& value,
                             std::vector<std::pair<std::string, Value>> choices,
                             const std::string& text) {
        std::vector<std::string> known;
        known.reserve(choices.size());
        std::string preset;
        for (const auto& choice : choices) {
            known.push_back(choice.first);
            if (choice.second == value) preset = choice.first;
        }
        const auto take = [&value, choices = std::move(choices)](const std::string& name) {
            for (const auto& choice : choices)
                if (choice.first == name) value = choice.second;
        };
        CommandOption option = add_parsed(names, take, text).one_of(known);
        return preset.empty() ? option : option.default_text(preset);
    }
    /// The same, for the values of a table.
    template <typename Target, typename Value, std::size_t kCount>
    CommandOption add_choice(const std::string& names, Target& value,
                             const std::array<NamedValue<Value>, kCount>& table,
                             const std::string& text) {
        std::vector<std::pair<std::string, Target>> choices;
        choices.reserve(kCount);
        for (const auto& [name, choice] : table) choices.emplace_back(name, choice);
        return add_choice(names, value, std::move(choices), text);
    }
    CommandOption add_flag(const std::string& names, bool& value, const std::string& text);
    /// A flag that does something.
    CommandOption add_flag(const std::string& names, std::function<void()> act,
                           const std::string& text);
    /// A flag that may have a value, --flag=VALUE; "true" without.
    CommandOption add_flag(const std::string& names, std::string& value, const std::string& text);

    /// An option that was added before.
    [[nodiscard]] CommandOption option(const std::string& name);
    /// For callbacks. \throws UsageError naming the first of these options that was given, although
    /// it has no effect here; `why` gives the reason and the remedy.
    void refuse(const std::vector<std::string>& names, const std::string& why) const;

    /// This one, if it has no subcommands, else those below it that have none.
    [[nodiscard]] std::vector<Command> leaves();

  private:
    [[nodiscard]] CommandOption handle(CLI::Option* option) { return {*option, *declared_}; }

    CLI::App* app_;
    DeclaredOptions* declared_;
};

/// The whole command line of a program.
class CommandLine {
  public:
    /// Without a version there is no --version.
    CommandLine(const std::string& program, const std::string& text,
                const std::string& version = {});
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    [[nodiscard]] Command root() { return {*app_, declared_}; }
    /// As it was declared.
    [[nodiscard]] CommandDescription description() const;
    /// Whether an output that was given is "-".
    [[nodiscard]] bool writes_to_standard_output() const;
    enum class Parsed { kAction, kHelp, kWrong };
    /// Parses the command line and runs the callbacks of the subcommand that it names. Prints help
    /// and version if they are asked for, and a message if the command line is wrong.
    /// \throws std::system_error if standard output cannot be written.
    [[nodiscard]] Parsed parse(int argc, char** argv);

  private:
    void check_files() const;

    std::unique_ptr<CLI::App> app_;
    DeclaredOptions declared_;
};

}  // namespace stipple
