#pragma once

#include <cstdlib>

namespace stipple {

/// Ends the program, which a fuzzer takes for a finding, unless the property holds.
inline void require(bool property) {
    if (!property) std::abort();
}

}  // namespace stipple
