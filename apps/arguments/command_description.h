#pragma once

#include <string>
#include <vector>

namespace stipple {

/// The heading of the help for the options that all commands share.
inline constexpr auto kCommonOptions = "Options of every command";

/// An option or a positional argument, as the help shows it.
struct OptionDescription {
    std::vector<std::string> names;    ///< as "-o", "--output"; of an argument its name alone
    std::string value;                 ///< as "FILE"; empty: a flag, or an argument
    std::string text;                  ///< a line, with the default value
    std::string group;                 ///< heading of the help under which it stands
    std::vector<std::string> choices;  ///< all values that it takes, if these have names
    std::string list;                  ///< `stipple list` knows its values by this name, or empty
    bool argument = false;             ///< positional
    bool required = false;
    bool repeats = false;  ///< may be given several times
};

/// A command with its subcommands: the source of manual pages, completions and the
/// command line's page of the site.
struct CommandDescription {
    std::string name;    ///< whole, as "stipple capture record"
    std::string text;    ///< a line
    std::string footer;  ///< examples
    std::vector<OptionDescription> options;
    std::vector<CommandDescription> commands;
};

}  // namespace stipple
