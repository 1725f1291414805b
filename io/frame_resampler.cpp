#include "io/frame_resampler.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/light.h"
#include "core/parallel.h"

namespace stipple {
namespace {

/// Times this close, in frames, are the same: rates such as 29.97 frames/s are rounded.
constexpr double kSameTime = 1e-6;

/// Of the collected light where frames of the mean light a and b meet. `of_a` is the weight of a:
/// the share that b has in the time of both.
float slope(float a, float b, float of_a) {
    return std::min(of_a * a + (1 - of_a) * b, 3 * std::min(a, b));
}

/// Hermite's basis: the light collected in a frame until its phase s is
/// middle x (mean light of the frame) + left x (slope at its begin) + right x (slope at its end).
struct CollectedWeights {
    float middle;
    float left;
    float right;

    /// From the phase `begin` to the phase `end` of a frame of this length.
    CollectedWeights(double begin, double end, double length)
        : middle(static_cast<float>(length * (rise(end) - rise(begin)))),
          left(static_cast<float>(length * (out(end) - out(begin)))),
          right(static_cast<float>(length * (in(end)-in(begin)))) {}

    static double rise(double s) { return s * s * (3 - 2 * s); }
    static double out(double s) { return s * (1 - s) * (1 - s); }
    static double in(double s) { return s * s * (s - 1); }
};

/// Bilinear; outside the plane its border.
float sample(std::span<const float> plane, FrameShape shape, float col, float row) {
    const float x = std::clamp(col, 0.0F, static_cast<float>(shape.cols - 1));
    const float y = std::clamp(row, 0.0F, static_cast<float>(shape.rows - 1));
    const int left = std::min(static_cast<int>(x), std::max(shape.cols - 2, 0));
    const int top = std::min(static_cast<int>(y), std::max(shape.rows - 2, 0));
    const auto at = [&](int dy, int dx) {
        const int r = std::min(top + dy, shape.rows - 1);
        const int c = std::min(left + dx, shape.cols - 1);
        return plane[static_cast<std::size_t>(r) * static_cast<std::size_t>(shape.cols) +
                     static_cast<std::size_t>(c)];
    };
    const float fx = x - static_cast<float>(left);
    const float fy = y - static_cast<float>(top);
    const float upper = at(0, 0) + fx * (at(0, 1) - at(0, 0));
    const float lower = at(1, 0) + fx * (at(1, 1) - at(1, 0));
    return upper + fy * (lower - upper);
}

}  // namespace

std::int64_t resampled_slots(std::int64_t frames, double frames_per_slot) {
    assert(frames_per_slot >= kMinFramesPerSlot);
    return static_cast<std::int64_t>((static_cast<double>(frames) + kSameTime) / frames_per_slot);
}

FrameResampler::FrameResampler(FrameShape shape, ResamplingOptions options, Source source)
    : shape_(shape),
      options_(std::move(options)),
      source_(std::move(source)),
      light_(shape.sites()) {
    assert(options_.frames_per_slot >= kMinFramesPerSlot &&
           options_.frames_per_slot <= kMaxFramesPerSlot);
    if (std::min(shape.rows, shape.cols) < options_.min_flow_side) options_.flow = {};
}

bool FrameResampler::have(std::int64_t index) {
    while (!ended_ && first_ + static_cast<std::int64_t>(frames_.size()) <= index) {
        const auto next = source_();
        ended_ = next.empty();
        if (ended_) break;
        const std::int64_t number = first_ + static_cast<std::int64_t>(frames_.size());
        const double time = options_.time ? options_.time() : static_cast<double>(number);
        if (number == 0) origin_ = time;
        frames_.push_back({time - origin_, {next.begin(), next.end()}});
    }
    return index < first_ + static_cast<std::int64_t>(frames_.size());
}

const FrameResampler::Frame& FrameResampler::frame(std::int64_t index) const {
    return frames_[static_cast<std::size_t>(index - first_)].light;
}

double FrameResampler::begin_of(std::int64_t index) const {
    return frames_[static_cast<std::size_t>(index - first_)].begin;
}

double FrameResampler::end_of(std::int64_t index) {
    return options_.time && have(index + 1) ? begin_of(index + 1) : begin_of(index) + 1;
}

bool FrameResampler::advance() {
    // Unequal frames may be so short that several lie within the half frame by which moments lag.
    const std::int64_t kept = options_.method == Resampling::kFlow && options_.time ? 8 : 1;
    for (++at_; first_ < at_ - kept; ++first_) frames_.pop_front();
    return have(at_);
}

/// Goes to the frame of this time; false at the end.
bool FrameResampler::reach(double time) {
    if (!have(at_)) return false;
    while (end_of(at_) <= time + kSameTime)
        if (!advance()) return false;
    return true;
}

std::span<const float> FrameResampler::next() {
    const double length = options_.frames_per_slot;
    const double begin = static_cast<double>(slot_) * length;
    const double end = static_cast<double>(slot_ + 1) * length;
    const double within_end = end - 2 * kSameTime;
    ++slot_;
    if (!reach(begin)) return {};
    if (options_.method == Resampling::kHold) {
        light_ = frame(at_);
    } else if (options_.method == Resampling::kFlow && length < 1 - kSameTime) {
        if (!reach(within_end)) return {};
        interpolate((begin + end) / 2 - 0.5);
    } else if (!blend(begin, end)) {
        return {};
    }
    return reach(within_end) ? std::span<const float>(light_) : std::span<const float>();
}

bool FrameResampler::blend(double begin, double end) {
    std::ranges::fill(light_, 0.0F);
    for (add_part(begin, end); end_of(at_) < end - kSameTime; add_part(begin, end))
        if (!advance()) return false;
    const auto scale = static_cast<float>(1 / options_.frames_per_slot);
    if (std::abs(options_.frames_per_slot - 1) > kSameTime)
        for (float& light : light_) light *= scale;
    return true;
}

/// Adds the light of the frame at hand in a slot.
void FrameResampler::add_part(double begin, double end) {
    const double length = end_of(at_) - begin_of(at_);
    const auto phase = [&](double time) {
        const double exact = (time - begin_of(at_)) / length;
        if (exact < kSameTime) return 0.0;
        return exact > 1 - kSameTime ? 1.0 : exact;
    };
    const CollectedWeights weights(phase(begin), phase(end), length);
    const bool has_before = at_ > first_;
    const bool has_next = have(at_ + 1);
    const auto share_in = [&](double neighbour) {
        return static_cast<float>(neighbour / (length + neighbour));
    };
    const float of_before = has_before ? 1 - share_in(begin_of(at_) - begin_of(at_ - 1)) : 0.5F;
    const float of_own = has_next ? share_in(end_of(at_ + 1) - begin_of(at_ + 1)) : 0.5F;
    const Frame& own = frame(at_);
    const Frame& before = has_before ? frame(at_ - 1) : own;
    const Frame& after = has_next ? frame(at_ + 1) : own;
    for (std::size_t site = 0; site < own.size(); ++site)
        light_[site] += weights.middle * own[site] +
                        weights.left * slope(before[site], own[site], of_before) +
                        weights.right * slope(own[site], after[site], of_own);
}

void FrameResampler::interpolate(double time) {
    std::int64_t index = at_;
    while (index > first_ && begin_of(index) > time) --index;
    if (!have(index + 1)) {
        light_ = frame(index);
        return;
    }
    const double length = begin_of(index + 1) - begin_of(index);
    const double phase = std::max(time - begin_of(index), 0.0) / length;
    if (phase < kSameTime) {
        light_ = frame(index);
        return;
    }
    if (flow_of_ != index) find_flow(index);
    parallel_for(0, shape_.rows, [&](int row) { move_row(row, index, static_cast<float>(phase)); });
}

void FrameResampler::find_flow(std::int64_t index) {
    flow_of_ = index;
    forth_.assign(2 * shape_.pixels(), 0.0F);
    back_.assign(2 * shape_.pixels(), 0.0F);
    if (!options_.flow) return;
    std::array<Frame, 2> images;
    for (std::size_t i = 0; i < 2; ++i) {
        const Frame& light = frame(index + static_cast<std::int64_t>(i));
        images[i].resize(shape_.pixels());
        if (shape_.planes == 3)
            reduce_to_luminance(light, images[i]);
        else
            images[i] = light;
    }
    const PlaneView<const float> from(images[0].data(), shape_.rows, shape_.cols);
    const PlaneView<const float> to(images[1].data(), shape_.rows, shape_.cols);
    options_.flow(from, to, forth_);
    options_.flow(to, from, back_);
}

void FrameResampler::move_row(int row, std::int64_t index, float phase) {
    const float s = phase;
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(shape_.cols);
    for (int col = 0; col < shape_.cols; ++col) {
        const std::size_t pixel = begin + static_cast<std::size_t>(col);
        std::array<float, 2> to_before{};
        std::array<float, 2> to_after{};
        for (std::size_t axis = 0; axis < 2; ++axis) {
            const float forth = forth_[2 * pixel + axis];
            const float back = back_[2 * pixel + axis];
            to_before[axis] = -(1 - s) * s * forth + s * s * back;
            to_after[axis] = (1 - s) * (1 - s) * forth - s * (1 - s) * back;
        }
        const auto x = static_cast<float>(col);
        const auto y = static_cast<float>(row);
        for (std::size_t plane = 0; plane < static_cast<std::size_t>(shape_.planes); ++plane) {
            const auto plane_of = [&](std::int64_t i) {
                return std::span(frame(i)).subspan(plane * shape_.pixels(), shape_.pixels());
            };
            const float before =
                sample(plane_of(index), shape_, x + to_before[0], y + to_before[1]);
            const float after =
                sample(plane_of(index + 1), shape_, x + to_after[0], y + to_after[1]);
            light_[plane * shape_.pixels() + pixel] = (1 - s) * before + s * after;
        }
    }
}

}  // namespace stipple
