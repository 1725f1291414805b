#pragma once

#include <string>

namespace stipple {

/// The page of `stipple explore`: one HTML file that needs nothing else, with its style, its
/// program and the library of charts. `data`: JSON as page/exploration/data.js reads it.
[[nodiscard]] std::string exploration_page(const std::string& title, const std::string& data);

}  // namespace stipple
