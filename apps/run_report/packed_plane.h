#pragma once

#include <string>
#include <vector>

namespace stipple {

/// A block of data in the page: base64 (plane_code.h) under a name.
struct PackedPlane {
    std::string id;
    std::string text;
};

}  // namespace stipple
