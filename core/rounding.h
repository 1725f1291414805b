#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/named_value.h"

namespace stipple {

/// How the converter maps a level between two digital numbers (DN).
enum class Rounding : std::uint8_t { kNearest = 0, kFloor = 1 };

inline constexpr auto kRoundings = std::to_array<NamedValue<Rounding>>(
    {{"nearest", Rounding::kNearest}, {"floor", Rounding::kFloor}});

[[nodiscard]] constexpr std::string_view name_of(Rounding rounding) {
    return name_in(kRoundings, rounding);
}

}  // namespace stipple
