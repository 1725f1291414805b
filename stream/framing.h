#pragma once

#include <cstdint>

namespace stipple {

/// The values of a stream header on which packets and end marker depend (`framing_of`).
struct Framing {
    int version = 2;
    std::uint32_t seed = 0;  ///< header CRC, from which their CRCs continue; 0 in version 1
};

}  // namespace stipple
