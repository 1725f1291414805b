#pragma once

#include <cstdint>
#include <limits>

#include "apps/command_line.h"

namespace stipple {

// Checks of numbers. Unlike CLI11's own they refuse NaN and whole numbers that do not fit, and say
// an open range in words.

/// Finite, and least..most.
[[nodiscard]] ValueCheck number_check(double least,
                                      double most = std::numeric_limits<double>::max());
/// Finite and above 0.
[[nodiscard]] ValueCheck positive_check();
/// Without a fraction, and least..most.
[[nodiscard]] ValueCheck whole_check(
    std::uint64_t least, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

}  // namespace stipple
