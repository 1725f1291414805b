#include "sensor_model/colour_mosaic.h"

#include <cassert>
#include <cstddef>

#include "core/parallel.h"

namespace stipple {

void take_mosaic(ColourFilter filter, FrameShape shape, std::span<const float> frame,
                 std::span<float> mosaic) {
    assert(shape.planes == 3 && frame.size() == shape.sites() && mosaic.size() == shape.pixels());
    parallel_for(0, shape.rows, [&](int row) {
        const auto first = static_cast<std::size_t>(row) * static_cast<std::size_t>(shape.cols);
        for (int col = 0; col < shape.cols; ++col) {
            const auto plane = static_cast<std::size_t>(colour_plane(filter, row, col));
            const std::size_t pixel = first + static_cast<std::size_t>(col);
            mosaic[pixel] = frame[plane * shape.pixels() + pixel];
        }
    });
}

}  // namespace stipple
