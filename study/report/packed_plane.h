#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace stipple {

/// The most bytes of the page that a plane takes beside its text.
inline constexpr std::size_t kPlaneTagBytes = 64;

/// A block of data in the page: base64 (plane_code.h) under a name.
struct PackedPlane {
    std::string id;
    std::string text;
};

}  // namespace stipple
