#pragma once

#include <string>
#include <vector>

namespace stipple {

/// The names of things that have one, for CommandOption::one_of.
template <typename Things>
[[nodiscard]] std::vector<std::string> names_of(const Things& things) {
    std::vector<std::string> names;
    for (const auto& thing : things) names.emplace_back(thing.name);
    return names;
}

}  // namespace stipple
