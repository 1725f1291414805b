#include "sensor_model/slot_light.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// Calls `body` with each row of each plane, and its index in all rows of all planes.
void for_each_row(FrameShape shape, const std::function<void(int row, std::size_t first)>& body) {
    parallel_for(0, shape.rows * shape.planes,
                 [&](int i) { body(i % shape.rows, row_major(i, 0, shape.cols)); });
}

/// A row of pixels and the rows beside it.
struct RowNeighbours {
    const float* above;
    const float* here;
    const float* below;
    int cols;

    [[nodiscard]] float sum(int col) const {
        const float left = here[std::max(col - 1, 0)];
        const float right = here[std::min(col + 1, cols - 1)];
        return (above[col] + below[col]) + (left + right);
    }
};

/// The row that begins at `first`; at the edges of the plane it is its own neighbour.
RowNeighbours neighbours(std::span<const float> frame, FrameShape shape, int row,
                         std::size_t first) {
    const float* here = &frame[first];
    return {row > 0 ? here - shape.cols : here, here,
            row + 1 < shape.rows ? here + shape.cols : here, shape.cols};
}

}  // namespace

SlotLight::SlotLight(const PhysicalTerms& terms, FrameShape shape)
    : shape_(shape),
      skew_slots_(static_cast<float>(terms.row_skew_slots)),
      crosstalk_(static_cast<float>(terms.crosstalk)),
      blooming_(static_cast<float>(terms.blooming)) {
    arriving_.resize(shape.sites());
    if (skew_slots_ == 0) return;
    before_.resize(shape.sites());
    late_.resize(shape.sites());
}

bool SlotLight::changes(const PhysicalTerms& terms) {
    return terms.row_skew_slots != 0 || terms.crosstalk != 0 || terms.blooming != 0;
}

void SlotLight::delay(std::span<const float> frame) {
    if (first_) std::ranges::copy(frame, before_.begin());
    first_ = false;
    for_each_row(shape_, [&](int row, std::size_t first) {
        const float before = shape_.rows > 1 ? skew_slots_ * static_cast<float>(row) /
                                                   static_cast<float>(shape_.rows - 1)
                                             : 0;
        const float now = 1 - before;
        // A share of 0 is left out: 0 of infinite light is not a number.
        for (std::size_t i = first; i < first + index(shape_.cols); ++i)
            late_[i] = before == 0 ? frame[i]
                       : now == 0  ? before_[i]
                                   : now * frame[i] + before * before_[i];
    });
    std::ranges::copy(frame, before_.begin());
}

std::span<const float> SlotLight::arriving(std::span<const float> frame) {
    assert(frame.size() == shape_.sites());
    if (skew_slots_ != 0) {
        delay(frame);
        frame = late_;
    }
    if (crosstalk_ == 0 && blooming_ == 0) return frame;
    if (crosstalk_ == 0) {
        std::ranges::copy(frame, arriving_.begin());
        return arriving_;
    }
    const float kept = 1 - crosstalk_, share = crosstalk_ / 4;
    for_each_row(shape_, [&](int row, std::size_t first) {
        const RowNeighbours from = neighbours(frame, shape_, row, first);
        for (int col = 0; col < shape_.cols; ++col)
            arriving_[first + index(col)] = kept * from.here[col] + share * from.sum(col);
    });
    return arriving_;
}

std::span<const float> SlotLight::with_overflow(std::span<const float> overflow) {
    assert(overflow.size() == shape_.sites());
    const float share = blooming_ / 4;
    for_each_row(shape_, [&](int row, std::size_t first) {
        const RowNeighbours from = neighbours(overflow, shape_, row, first);
        for (int col = 0; col < shape_.cols; ++col)
            arriving_[first + index(col)] += share * from.sum(col);
    });
    return arriving_;
}

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
