#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace stipple {

/// A message about the first word in place of a subcommand that names none, with the most similar
/// name. Empty if there is no such word.
[[nodiscard]] std::string unknown_subcommand(const CLI::App& program,
                                             std::span<const std::string> words);

/// The message for `words` that `program` could not parse. A misspelt word is reported before a
/// missing one; the command for help is added.
[[nodiscard]] std::string usage_problem(const CLI::App& program, std::span<const std::string> words,
                                        const CLI::ParseError& error);

}  // namespace stipple
