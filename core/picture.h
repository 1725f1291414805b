#pragma once

#include <vector>

#include "core/geometry.h"

namespace stipple {

/// One decoded picture, order (plane, row, col). Integers are scaled to 0..1 (255 or 65535 = 1),
/// floating-point values are as the file holds them, unchecked.
struct Picture {
    FrameShape shape;
    std::vector<float> values;

    /// Takes the shape and makes room for its values.
    void resize(FrameShape new_shape) {
        shape = new_shape;
        values.resize(new_shape.sites());
    }
};

}  // namespace stipple
