#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// The name of `known` that a misspelt `name` probably means: the first one that begins with it, or
/// the one with the min edit distance, if that is at most a third of its characters.
/// Edits are insertions, deletions, replacements and swaps of neighbours; case is ignored. Empty if
/// there is none.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& known);

/// Message on a `name` that is not in `known`: `did you mean "x"?`, or the list of known names.
[[nodiscard]] std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace stipple
