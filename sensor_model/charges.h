#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// Charge of a pixel at the end of an exposure, as the input of the ADC.
struct Charge {
    float electrons = 0;   ///< noise included; may be negative
    bool clipped = false;  ///< the full well has limited it
};

/// Charges of a list of pixels.
struct Charges {
    std::span<float> electrons;
    std::span<std::uint8_t> clipped = {};  ///< 0 or 1 per pixel; empty: not wanted
};

}  // namespace stipple
