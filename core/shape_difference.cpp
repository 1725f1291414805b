#include "core/shape_difference.h"

#include <fmt/format.h>

namespace stipple {

std::string shape_text(FrameShape shape) {
    return fmt::format("{} x {} x {}", shape.cols, shape.rows, shape.planes);
}

std::string shape_difference(FrameShape found, FrameShape wanted, std::string_view others) {
    return fmt::format("has frames of {} (width x height x planes), {} {}", shape_text(found),
                       others, shape_text(wanted));
}

}  // namespace stipple
