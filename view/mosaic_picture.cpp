#include "view/mosaic_picture.h"

#include <algorithm>

#include "core/index.h"

namespace stipple {

std::vector<float> coloured(std::span<const float> mosaic, FrameShape shape, ColourFilter filter) {
    std::vector<float> light(3 * shape.pixels());
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col) {
            const int cell_row = std::max(std::min(row / 2 * 2, shape.rows - 2), 0);
            const int cell_col = std::max(std::min(col / 2 * 2, shape.cols - 2), 0);
            float sum[3] = {}, count[3] = {};
            for (int r = cell_row; r < std::min(cell_row + 2, shape.rows); ++r)
                for (int c = cell_col; c < std::min(cell_col + 2, shape.cols); ++c) {
                    const auto plane = index(colour_plane(filter, r, c));
                    sum[plane] += mosaic[row_major(r, c, shape.cols)];
                    ++count[plane];
                }
            for (std::size_t plane = 0; plane < 3; ++plane)
                if (count[plane] > 0)
                    light[plane * shape.pixels() + row_major(row, col, shape.cols)] =
                        sum[plane] / count[plane];
        }
    return light;
}

}  // namespace stipple
