#include "capture/setting_value.h"

#include <charconv>
#include <cmath>

namespace stipple {
namespace {

template <typename Number, typename... Form>
std::optional<Number> whole_text(std::string_view text, Form... form) {
    Number value{};
    const char* const end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(text.data(), end, value, form...);
    if (error != std::errc{} || stopped != end) return std::nullopt;
    return value;
}

}  // namespace

std::optional<std::int64_t> integer_setting(std::string_view text) {
    constexpr std::string_view kHexadecimal = "0x";
    if (text.substr(0, 2) != kHexadecimal) return whole_text<std::int64_t>(text);
    const std::string_view digits = text.substr(2);
    return digits.substr(0, 1) == "-" ? std::nullopt : whole_text<std::int64_t>(digits, 16);
}

std::optional<double> number_setting(std::string_view text) {
    const auto value = whole_text<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace stipple
