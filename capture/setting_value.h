#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace stipple {

/// The text of a camera setting as a whole number, decimal or 0x...; nothing if it is anything else
/// or does not fit.
[[nodiscard]] std::optional<std::int64_t> integer_setting(std::string_view text);

/// As a finite number; nothing if it is anything else.
[[nodiscard]] std::optional<double> number_setting(std::string_view text);

}  // namespace stipple
