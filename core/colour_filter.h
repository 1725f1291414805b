#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/named_value.h"

namespace stipple {

/// The colour filter array of a sensor with one plane: the colours of a 2x2 cell, row by row.
enum class ColourFilter : std::uint8_t { kNone = 0, kRggb = 1, kGrbg = 2, kGbrg = 3, kBggr = 4 };

inline constexpr auto kColourFilters =
    std::to_array<NamedValue<ColourFilter>>({{"none", ColourFilter::kNone},
                                             {"rggb", ColourFilter::kRggb},
                                             {"grbg", ColourFilter::kGrbg},
                                             {"gbrg", ColourFilter::kGbrg},
                                             {"bggr", ColourFilter::kBggr}});

[[nodiscard]] constexpr std::string_view name_of(ColourFilter filter) {
    return name_in(kColourFilters, filter);
}

/// The plane of RGB footage (0, 1, 2) that the pixel sees. Precondition: not kNone, row, col >= 0.
[[nodiscard]] constexpr int colour_plane(ColourFilter filter, int row, int col) {
    constexpr std::array<std::array<int, 4>, 5> kPlanes{
        {{0, 0, 0, 0}, {0, 1, 1, 2}, {1, 0, 2, 1}, {1, 2, 0, 1}, {2, 1, 1, 0}}};
    return kPlanes[static_cast<std::size_t>(filter)]
                  [static_cast<std::size_t>(row % 2 * 2 + col % 2)];
}

}  // namespace stipple
