#pragma once

#include <span>
#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace stipple {

/// The word among `words` that stands for a subcommand and is none: says so, and which was probably
/// meant. Empty if there is no such word.
[[nodiscard]] std::string unknown_subcommand(const CLI::App& program,
                                             std::span<const std::string> words);

/// What is wrong with `words`, which `program` could not take apart: what is misspelt comes before
/// what is missing, and how to get help is added.
[[nodiscard]] std::string usage_problem(const CLI::App& program, std::span<const std::string> words,
                                        const CLI::ParseError& error);

}  // namespace stipple
