#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace stipple {

/// The text of a camera setting as an integer, decimal or 0x...; empty for any other text, or out
/// of range.
[[nodiscard]] std::optional<std::int64_t> integer_setting(std::string_view text);

/// The same as a finite number; empty for any other text.
[[nodiscard]] std::optional<double> number_setting(std::string_view text);

}  // namespace stipple
