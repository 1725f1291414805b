#pragma once

#include <cstdint>
#include <span>

namespace stipple {

/// What a pixel holds at the end of an exposure, as the converter sees it.
struct Charge {
    float electrons = 0;   ///< noise included; may be negative
    bool clipped = false;  ///< more was collected than the full well holds
};

/// The same of a list of pixels.
struct Charges {
    std::span<float> electrons;
    std::span<std::uint8_t> clipped = {};  ///< 0 or 1; as many, or none: not asked for
};

}  // namespace stipple
