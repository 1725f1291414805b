#include "readout/light_warp.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {

LightWarp::LightWarp(const Homography& from_reference, FrameShape shape) : shape_(shape) {
    if (from_reference.is_identity()) return;
    const Homography to_reference = from_reference.inverse();
    taps_.reserve(shape.pixels());
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col)
            taps_.push_back(
                taps_at(to_reference({static_cast<double>(row), static_cast<double>(col)}), shape));
    warped_.resize(shape.sites());
}

LightWarp::Taps LightWarp::taps_at(FramePoint place, FrameShape shape) {
    // max first: what is not finite becomes the edge.
    const double row = std::min(std::max(0.0, place.row), shape.rows - 1.0);
    const double col = std::min(std::max(0.0, place.col), shape.cols - 1.0);
    const auto top = static_cast<int>(row);
    const auto left = static_cast<int>(col);
    const int bottom = std::min(top + 1, shape.rows - 1);
    const int right = std::min(left + 1, shape.cols - 1);
    const auto down = static_cast<float>(row - top);
    const auto across = static_cast<float>(col - left);
    const auto at = [&](int r, int c) {
        return static_cast<std::uint32_t>(row_major(r, c, shape.cols));
    };
    return {{at(top, left), at(top, right), at(bottom, left), at(bottom, right)},
            {(1 - down) * (1 - across), (1 - down) * across, down * (1 - across), down * across}};
}

std::span<const float> LightWarp::operator()(std::span<const float> frame) {
    if (taps_.empty()) return frame;
    const auto cols = index(shape_.cols);
    parallel_for(0, shape_.planes * shape_.rows, [&](int line) {
        const std::size_t plane = index(line / shape_.rows) * shape_.pixels();
        const std::size_t first = index(line % shape_.rows) * cols;
        for (std::size_t pixel = first; pixel < first + cols; ++pixel) {
            const Taps& taps = taps_[pixel];
            float light = 0;
            for (std::size_t i = 0; i < taps.pixel.size(); ++i)
                light += taps.weight[i] * frame[plane + taps.pixel[i]];
            warped_[plane + pixel] = light;
        }
    });
    return warped_;
}

}  // namespace stipple
