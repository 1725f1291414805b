#include "study/training/moving_crop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/index.h"
#include "core/plane.h"

namespace stipple {
namespace {

void check(bool is_right, const char* problem) {
    if (!is_right) throw InputError("crop", problem);
}

/// Whether `length` pixels from each of these on lie in 0 .. `end`.
bool all_within(std::span<const double> begins, int length, int end) {
    return std::ranges::all_of(begins,
                               [&](double begin) { return begin >= 0 && begin <= end - length; });
}

void check(const Clip& clip, const MovingCrop& crop, FrameShape shape) {
    const auto is_positive = [](double value) { return value > 0 && std::isfinite(value); };
    check(!crop.top.empty() && crop.top.size() == crop.left.size(),
          "has no slots, or not a place for each");
    check(
        is_positive(crop.frames_per_slot) && is_positive(crop.light) && is_positive(crop.contrast),
        "has a speed, light or contrast that is not above 0");
    check(shape.planes == clip.shape.planes, "has other planes than the clip");
    check(shape.rows > 0 && shape.cols > 0 && all_within(crop.top, shape.rows, clip.shape.rows) &&
              all_within(crop.left, shape.cols, clip.shape.cols),
          "reaches beyond the frames of the clip");
    const auto slots = static_cast<double>(crop.top.size());
    check(crop.first_frame >= 0 && crop.first_frame + slots * crop.frames_per_slot <= clip.frames,
          "reaches beyond the end of the clip");
}

/// to += weight x the part of `frame` whose corner is at (top, left).
void add(PlaneView<const float> frame, double top, double left, float weight, PlaneView<float> to) {
    const auto first_row = static_cast<int>(top);
    const auto first_col = static_cast<int>(left);
    const auto down = static_cast<float>(top - first_row);
    const auto right = static_cast<float>(left - first_col);
    const float upper = weight * (1 - down);
    const float lower = weight * down;
    const std::size_t step = right > 0 ? 1 : 0;
    for (int row = 0; row < to.rows(); ++row) {
        const auto sum = to.row(row);
        const float* above = frame.row(first_row + row).data() + first_col;
        const float* below = frame.row(first_row + row + (down > 0 ? 1 : 0)).data() + first_col;
        for (std::size_t col = 0; col < sum.size(); ++col) {
            const float here = upper * above[col] + lower * below[col];
            const float next = upper * above[col + step] + lower * below[col + step];
            sum[col] += here + right * (next - here);
        }
    }
}

/// One slot, whose light is 0 before.
void take_slot(const Clip& clip, const MovingCrop& crop, int slot, std::span<float> light,
               FrameShape shape) {
    const double begin = crop.first_frame + slot * crop.frames_per_slot;
    const double end = begin + crop.frames_per_slot;
    for (int frame = static_cast<int>(begin); frame < end && frame < clip.frames; ++frame) {
        const double share =
            (std::min(end, frame + 1.0) - std::max(begin, 1.0 * frame)) / crop.frames_per_slot;
        for (int plane = 0; plane < shape.planes; ++plane) {
            const std::size_t from =
                index(frame) * clip.shape.sites() + index(plane) * clip.shape.pixels();
            add({clip.light.data() + from, clip.shape.rows, clip.shape.cols}, crop.top[index(slot)],
                crop.left[index(slot)], static_cast<float>(share),
                {light.data() + index(plane) * shape.pixels(), shape.rows, shape.cols});
        }
    }
    const auto factor = static_cast<float>(crop.light);
    if (crop.contrast == 1) {
        for (float& value : light) value *= factor;
    } else {
        const auto power = static_cast<float>(crop.contrast);
        for (float& value : light) value = factor * std::pow(value, power);
    }
}

}  // namespace

std::vector<float> take_crop(const Clip& clip, const MovingCrop& crop, FrameShape shape) {
    check(clip, crop, shape);
    std::vector<float> light(crop.top.size() * shape.sites());
    for (std::size_t slot = 0; slot < crop.top.size(); ++slot)
        take_slot(clip, crop, static_cast<int>(slot),
                  std::span(light).subspan(slot * shape.sites(), shape.sites()), shape);
    return light;
}

}  // namespace stipple
