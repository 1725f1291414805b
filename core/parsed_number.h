#pragma once

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace stipple {

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
