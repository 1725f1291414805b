#pragma once

#include <cstdint>

namespace stipple {

/// Counts of the emulated chip since its first slot.
struct ReadoutStats {
    std::int64_t slots = 0;  ///< the slot to expose next
    std::uint64_t samples = 0;
    std::uint64_t saturated_samples = 0;  ///< clipped by the full well, or at full scale
    std::uint64_t zero_samples = 0;       ///< at DN 0, where noise is cut off
};

}  // namespace stipple
