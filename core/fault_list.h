#pragma once

#include <cstddef>

namespace stipple {

/// Max entries of a list of faults in reports and JSON: damaged places, gaps, late slots. Further
/// faults are only counted, so that a bad file of any size is reported in bounded memory.
inline constexpr std::size_t kMaxListedFaults = 1000;

/// Max entries of such a list in a text.
inline constexpr std::size_t kMaxShownFaults = 10;

}  // namespace stipple
