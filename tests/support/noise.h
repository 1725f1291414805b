#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

/// Evenly distributed values in [0, 1) of a linear congruential generator (Numerical Recipes), the
/// same on any machine.
inline std::vector<float> noise(std::size_t count, std::uint32_t state) {
    std::vector<float> values(count);
    for (float& value : values) {
        state = state * 1664525U + 1013904223U;
        value = static_cast<float>(state >> 8U) / 16777216.0F;
    }
    return values;
}

}  // namespace stipple
