#include "decoder/reddy2011/sparse_frames.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/index.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// The four pixels around the place that a flow leads to, and their bilinear weights.
struct Target {
    std::size_t first;  ///< pixel at the top left
    std::array<float, 4> weights;
};

/// Calls body(pixel, target) for the links of a slot.
template <typename Body>
void for_each_link(const MotionField& field, FrameShape shape, int slot, const Body& body) {
    constexpr int kPerPixel = MotionField::kShiftsPerPixel;
    const std::size_t begin = index(slot) * shape.pixels();
    for (int row = 0; row < shape.rows; ++row)
        for (int col = 0; col < shape.cols; ++col) {
            const std::size_t pixel = row_major(row, col, shape.cols);
            if (field.confidence[begin + pixel] == 0) continue;
            const int down = row * kPerPixel + field.row_shift[begin + pixel];
            const int right = col * kPerPixel + field.col_shift[begin + pixel];
            const int top = std::min(down / kPerPixel, shape.rows - 2);
            const int left = std::min(right / kPerPixel, shape.cols - 2);
            const float y = static_cast<float>(down - top * kPerPixel) / kPerPixel;
            const float x = static_cast<float>(right - left * kPerPixel) / kPerPixel;
            body(pixel, Target{row_major(top, left, shape.cols),
                               {(1 - y) * (1 - x), (1 - y) * x, y * (1 - x), y * x}});
        }
}

/// The pixels of a target, in the order of its weights.
std::array<std::size_t, 4> pixels_of(const Target& target, FrameShape shape) {
    const std::size_t below = target.first + index(shape.cols);
    return {target.first, target.first + 1, below, below + 1};
}

float light_at(const Target& target, FrameShape shape, std::span<const float> plane) {
    const auto pixels = pixels_of(target, shape);
    float light = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) light += target.weights[i] * plane[pixels[i]];
    return light;
}

}  // namespace

FlowLinks::FlowLinks(std::vector<MotionField> motion, FrameShape shape, float min_confidence)
    : motion_(std::move(motion)), shape_(shape) {
    for (MotionField& field : motion_)
        for (std::uint8_t& confidence : field.confidence)
            if (static_cast<float>(confidence) < 255 * min_confidence) confidence = 0;
}

int FlowLinks::slots() const {
    return motion_.empty() ? 0 : static_cast<int>(motion_[0].confidence.size() / shape_.pixels());
}

void FlowLinks::add_gradient(const FluxVideo& x, float weight, std::span<float> gradient) const {
    const std::size_t pixels = shape_.pixels();
    parallel_for(0, x.slots() * shape_.planes, [&](int i) {
        const int slot = i / shape_.planes;
        const std::size_t plane = index(i % shape_.planes) * pixels;
        const auto light = [&](int s) { return x.frame(s).subspan(plane, pixels); };
        const auto to = gradient.subspan(index(slot) * shape_.sites() + plane, pixels);
        for (const MotionField& field : motion_) {
            const int partner = slot + field.step;
            if (partner >= 0 && partner < x.slots())  // the links that begin here
                for_each_link(field, shape_, slot, [&](std::size_t pixel, const Target& target) {
                    to[pixel] -=
                        weight * (light_at(target, shape_, light(partner)) - light(slot)[pixel]);
                });
            const int source = slot - field.step;
            if (source < 0 || source >= x.slots()) continue;
            for_each_link(field, shape_, source, [&](std::size_t pixel, const Target& target) {
                const float difference =
                    light_at(target, shape_, light(slot)) - light(source)[pixel];
                const auto ends = pixels_of(target, shape_);
                for (std::size_t k = 0; k < ends.size(); ++k)
                    to[ends[k]] += weight * target.weights[k] * difference;
            });
        }
    });
}

float FlowLinks::squared_norm_bound() const {
    constexpr float kRowSum = 2;  // 1 of the pixel, 1 of the four bilinear weights
    std::vector<float> most(index(slots()));
    parallel_for(0, slots(), [&](int slot) {
        std::vector<float> sums(shape_.pixels());
        for (const MotionField& field : motion_) {
            const int partner = slot + field.step;
            if (partner >= 0 && partner < slots())
                for_each_link(field, shape_, slot,
                              [&](std::size_t pixel, const Target&) { sums[pixel] += 1; });
            const int source = slot - field.step;
            if (source < 0 || source >= slots()) continue;
            for_each_link(field, shape_, source, [&](std::size_t, const Target& target) {
                const auto ends = pixels_of(target, shape_);
                for (std::size_t k = 0; k < ends.size(); ++k) sums[ends[k]] += target.weights[k];
            });
        }
        most[index(slot)] = *std::ranges::max_element(sums);
    });
    return most.empty() ? 0 : kRowSum * *std::ranges::max_element(most);
}

double FlowLinks::share() const {
    std::size_t links = 0;
    std::size_t all = 0;
    for (const MotionField& field : motion_) {
        links += field.confidence.size() - index(std::ranges::count(field.confidence, 0));
        all += field.confidence.size();
    }
    return all == 0 ? 0 : static_cast<double>(links) / static_cast<double>(all);
}

}  // namespace stipple
