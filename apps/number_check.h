#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>

namespace stipple {

/// A check for CLI11: the text's problem, or nothing. Unlike CLI11's own checks these refuse NaN
/// and whole numbers that do not fit, and say an open range in words.
using NumberCheck = std::function<std::string(const std::string&)>;

/// Finite, and least..most.
[[nodiscard]] NumberCheck number_check(double least,
                                       double most = std::numeric_limits<double>::max());
/// Finite and above 0.
[[nodiscard]] NumberCheck positive_check();
/// Without a fraction, and least..most.
[[nodiscard]] NumberCheck whole_check(
    std::uint64_t least, std::uint64_t most = std::numeric_limits<std::uint64_t>::max());

}  // namespace stipple
