#include "capture/setting_value.h"

#include <cmath>

#include "core/parsed_number.h"

namespace stipple {

std::optional<std::int64_t> integer_setting(std::string_view text) {
    constexpr std::string_view kHexadecimal = "0x";
    if (text.substr(0, 2) != kHexadecimal) return parsed_number<std::int64_t>(text);
    const std::string_view digits = text.substr(2);
    return digits.substr(0, 1) == "-" ? std::nullopt : parsed_number<std::int64_t>(digits, 16);
}

std::optional<double> number_setting(std::string_view text) {
    const auto value = parsed_number<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

}  // namespace stipple
