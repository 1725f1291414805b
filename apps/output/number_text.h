#pragma once

#include <fmt/format.h>

#include <cmath>
#include <concepts>
#include <string>
#include <string_view>

namespace stipple {

/// "1 frame", "2 frames".
[[nodiscard]] std::string counted(std::integral auto count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// Three digits, or so many, more in front of the point, never a power of ten: 0.0123, 1.23, 1234.
[[nodiscard]] inline std::string rounded(double value, int digits = 3) {
    return value >= std::pow(10, digits) - 0.5 ? fmt::format("{:.0f}", value)
                                               : fmt::format("{:.{}g}", value, digits);
}

/// "40 s", "5 min", "2.5 h".
[[nodiscard]] inline std::string rough_time(double seconds) {
    if (seconds < 90) return fmt::format("{:.0f} s", seconds);
    return seconds < 5400 ? fmt::format("{:.0f} min", seconds / 60)
                          : fmt::format("{} h", rounded(seconds / 3600, 2));
}

}  // namespace stipple
