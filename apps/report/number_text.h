#pragma once

#include <fmt/format.h>

#include <concepts>
#include <string>
#include <string_view>

namespace stipple {

/// "1 frame", "2 frames".
[[nodiscard]] std::string counted(std::integral auto count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Three digits, more in front of the point, never a power of ten: 0.0123, 1.23, 1234.
[[nodiscard]] inline std::string rounded(double value) {
    return value >= 1000 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

}  // namespace stipple
