#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/geometry.h"

namespace stipple {

/// "1 frame", "2 frames".
[[nodiscard]] std::string counted(std::integral auto count, std::string_view noun) {
    return std::to_string(count).append(1, ' ').append(noun).append(count == 1 ? "" : "s");
}

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

/// `argument` as a POSIX shell takes it for one word: as it is if all of its characters are plain,
/// else in single quotes.
[[nodiscard]] std::string shell_quoted(const std::string& argument);

/// The name of `known` that a misspelt `name` probably means: the first one that begins with it, or
/// the one with the min edit distance, if that is at most a third of its characters.
/// Edits are insertions, deletions, replacements and swaps of neighbours; case is ignored. Empty if
/// there is none.
[[nodiscard]] std::string nearest_name(std::string_view name,
                                       const std::vector<std::string>& known);

/// Message on a `name` that is not in `known`: `did you mean "x"?`, or the list of known names.
[[nodiscard]] std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// "640 x 480 x 3": width, height, planes.
[[nodiscard]] std::string shape_text(FrameShape shape);

/// Message on frames of a wrong shape: "has frames of 8 x 6 x 3 (width x height x planes), but the
/// reference has 8 x 6 x 1" for `others` = "but the reference has".
[[nodiscard]] std::string shape_difference(FrameShape found, FrameShape wanted,
                                           std::string_view others);

/// The number that all of `text` is; nothing for any other text, and outside the range of Number.
/// `form`: as of std::from_chars, the base of an integer. As there, no sign + and no blanks.
template <typename Number, typename... Form>
[[nodiscard]] std::optional<Number> parsed_number(std::string_view text, Form... form) {
    Number number{};
    const char* const end = text.data() + text.size();
    const auto [last, error] = std::from_chars(text.data(), end, number, form...);
    if (error != std::errc() || last != end) return std::nullopt;
    return number;
}

}  // namespace stipple
