#pragma once

#include <string>

namespace stipple {

/// The strings of `items` with ", " between them. (fmt::join makes g++ 12 warn at -O3.)
template <typename Strings>
[[nodiscard]] std::string joined(const Strings& items) {
    std::string text;
    for (const auto& item : items) {
        if (!text.empty()) text += ", ";
        text += item;
    }
    return text;
}

}  // namespace stipple
