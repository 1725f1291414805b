#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stipple {

/// The one of `known` that a misspelt `name` was probably meant to be: the first that begins with
/// it, or the one that the fewest edits lead to, less than half as many as it has characters
/// (inserted, deleted, replaced, or neighbours swapped; upper and lower case are the same). Empty
/// if there is none.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& known);

/// What to say of a `name` that is none of `known`: `did you mean "x"?`, or which are known.
[[nodiscard]] std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace stipple
