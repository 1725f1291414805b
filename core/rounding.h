#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace stipple {

/// How the converter maps a level between two digital numbers (DN).
enum class Rounding : std::uint8_t { kNearest = 0, kFloor = 1 };

/// Names by number, as in configuration files.
inline constexpr std::array<std::string_view, 2> kRoundingNames{"nearest", "floor"};

[[nodiscard]] constexpr std::string_view name_of(Rounding rounding) {
    return kRoundingNames[static_cast<std::size_t>(rounding)];
}

}  // namespace stipple
