#pragma once

#include <cstdint>

namespace stipple {

/// What the packets and the end marker of a stream have from its header (`framing_of`).
struct Framing {
    int version = 2;
    std::uint32_t seed = 0;  ///< their CRCs continue this one; 0 in version 1
};

}  // namespace stipple
