#include "decoder/motion/frame_interpolation.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

#include "core/index.h"
#include "core/parallel.h"
#include "core/plane.h"
#include "decoder/motion/bilinear.h"
#include "decoder/motion/motion.h"

namespace stipple {
namespace {

constexpr int kRadius = 4;  ///< of the box over which two frames are compared, pixels
constexpr int kHop = 4;     ///< to the pixels nearby whose motion is tried
constexpr int kHopPasses = 2;
constexpr int kFollowings = 2;         ///< of a motion back to where it begins
constexpr float kRootOffset = 0.002F;  ///< light that is added before the square root

/// Pixels from one frame to the next.
struct Shift {
    float rows = 0;
    float cols = 0;
};

/// out[i] = mean of the values at i - kRadius .. i + kRadius that there are.
void mean_along(std::size_t count, std::size_t stride, const float* in, float* out) {
    constexpr auto kReach = static_cast<std::size_t>(kRadius);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i - std::min(i, kReach);
        const std::size_t end = std::min(i + kReach + 1, count);
        float sum = 0;
        for (std::size_t k = begin; k < end; ++k) sum += in[k * stride];
        out[i * stride] = sum / static_cast<float>(end - begin);
    }
}

void box_mean(FrameShape shape, std::vector<float>& x) {
    const std::size_t cols = index(shape.cols);
    std::vector<float> across(x.size());
    for (std::size_t first = 0; first < x.size(); first += cols)
        mean_along(cols, 1, &x[first], &across[first]);
    for (std::size_t col = 0; col < cols; ++col)
        mean_along(index(shape.rows), cols, &across[col], &x[col]);
}

/// Square root of the light of all planes, where noise is even.
std::vector<float> root_of(const FluxVideo& frames, int frame) {
    std::vector<float> root(frames.shape().pixels(), kRootOffset);
    const auto light = frames.frame(frame);
    for (std::size_t i = 0; i < light.size(); ++i)
        root[i % root.size()] += std::max(light[i], 0.0F);
    for (float& value : root) value = std::sqrt(value);
    return root;
}

/// A slot between two frames, `share` of the way from the first to the second.
class Between {
  public:
    Between(const FluxVideo& frames, const std::vector<MotionField>& motion, int first, float share)
        : frames_(frames),
          shape_(frames.shape()),
          first_(first),
          share_(share),
          root_{root_of(frames, first), root_of(frames, first + 1)},
          shift_(shape_.pixels()),
          misfit_(shape_.pixels(), std::numeric_limits<float>::max()) {
        consider(std::vector<Shift>(shape_.pixels()));
        for (const MotionField& field : motion) follow(field);
        if (!motion.empty()) look_around();
    }

    void write(std::span<float> light) const {
        write(light,
              [this](Pair pair) { return pair.first + share_ * (pair.second - pair.first); });
    }

    /// The frame that is not at the time of this slot. Precondition: share is 0 or 1.
    void write_moved(std::span<float> light) const {
        write(light, [this](Pair pair) { return share_ > 0 ? pair.first : pair.second; });
    }

  private:
    struct Pair {
        float first;
        float second;
    };

    template <typename Blend>
    void write(std::span<float> light, const Blend& blend) const {
        for (int plane = 0; plane < shape_.planes; ++plane) {
            const auto before = frames_.plane(first_, plane);
            const auto after = frames_.plane(first_ + 1, plane);
            float* out = &light[index(plane) * shape_.pixels()];
            visit([&](std::size_t i, int row, int col) {
                out[i] = blend(along(before, after, row, col, shift_[i]));
            });
        }
    }

    template <typename Body>
    void visit(const Body& body) const {
        std::size_t i = 0;
        for (int row = 0; row < shape_.rows; ++row)
            for (int col = 0; col < shape_.cols; ++col, ++i) body(i, row, col);
    }

    /// What the frames show where a motion through (row, col) in this slot crosses them.
    [[nodiscard]] Pair along(PlaneView<const float> before, PlaneView<const float> after, int row,
                             int col, Shift shift) const {
        const auto y = static_cast<float>(row);
        const auto x = static_cast<float>(col);
        const float rest = 1 - share_;
        return {bilinear(before, y - share_ * shift.rows, x - share_ * shift.cols),
                bilinear(after, y + rest * shift.rows, x + rest * shift.cols)};
    }

    /// Each pixel takes its candidate if the frames differ less along it.
    void consider(const std::vector<Shift>& candidate) {
        const PlaneView<const float> before{root_[0].data(), shape_.rows, shape_.cols};
        const PlaneView<const float> after{root_[1].data(), shape_.rows, shape_.cols};
        std::vector<float> misfit(candidate.size());
        visit([&](std::size_t i, int row, int col) {
            const auto [a, b] = along(before, after, row, col, candidate[i]);
            misfit[i] = std::abs(a - b);
        });
        box_mean(shape_, misfit);
        for (std::size_t i = 0; i < candidate.size(); ++i)
            if (misfit[i] < misfit_[i]) {
                misfit_[i] = misfit[i];
                shift_[i] = candidate[i];
            }
    }

    [[nodiscard]] std::size_t nearest(float row, float col) const {
        const int r = std::clamp(static_cast<int>(row + 0.5F), 0, shape_.rows - 1);
        const int c = std::clamp(static_cast<int>(col + 0.5F), 0, shape_.cols - 1);
        return row_major(r, c, shape_.cols);
    }

    /// The motion of one frame: at the pixel, then where that motion comes from, and so on.
    void follow(const MotionField& field) {
        const bool forth = field.step > 0;
        const std::size_t begin = index(forth ? first_ : first_ + 1) * shape_.pixels();
        const float to_frame = forth ? -share_ : 1 - share_;
        const float scale = (forth ? 1.0F : -1.0F) / MotionField::kShiftsPerPixel;
        const auto motion_at = [&](std::size_t pixel) {
            return Shift{scale * field.row_shift[begin + pixel],
                         scale * field.col_shift[begin + pixel]};
        };
        std::vector<Shift> candidate(shape_.pixels());
        for (std::size_t i = 0; i < candidate.size(); ++i) candidate[i] = motion_at(i);
        consider(candidate);
        for (int n = 0; n < kFollowings; ++n) {
            visit([&](std::size_t i, int row, int col) {
                candidate[i] =
                    motion_at(nearest(static_cast<float>(row) + to_frame * candidate[i].rows,
                                      static_cast<float>(col) + to_frame * candidate[i].cols));
            });
            consider(candidate);
        }
    }

    void look_around() {
        constexpr int kHops[4][2] = {{-kHop, 0}, {kHop, 0}, {0, -kHop}, {0, kHop}};
        std::vector<Shift> candidate(shape_.pixels());
        for (int pass = 0; pass < kHopPasses; ++pass)
            for (const auto& [rows, cols] : kHops) {
                visit([&, rows = rows, cols = cols](std::size_t i, int row, int col) {
                    candidate[i] = shift_[nearest(static_cast<float>(row + rows),
                                                  static_cast<float>(col + cols))];
                });
                consider(candidate);
            }
    }

    const FluxVideo& frames_;
    FrameShape shape_;
    int first_;
    float share_;
    std::vector<float> root_[2];
    std::vector<Shift> shift_;   ///< the best so far
    std::vector<float> misfit_;  ///< along it
};

std::vector<MotionField> motion_of(const FluxVideo& frames) {
    const bool can_move =
        frames.slots() > 1 && std::min(frames.shape().rows, frames.shape().cols) >= kMinMotionSide;
    return can_move ? estimate_motion(frames, {}) : std::vector<MotionField>();
}

}  // namespace

FluxVideo interpolate_frames(const FluxVideo& frames, std::span<const float> centre_slots,
                             std::span<const float> times) {
    FluxVideo video(static_cast<int>(times.size()), frames.shape());
    const auto motion = motion_of(frames);
    parallel_for(0, video.slots(), [&](int i) {
        const float at = times[index(i)];
        const auto next = std::ranges::upper_bound(centre_slots, at);
        const auto after = static_cast<int>(next - centre_slots.begin());
        if (after == 0 || next == centre_slots.end()) {
            std::ranges::copy(frames.frame(std::max(after - 1, 0)), video.frame(i).begin());
            return;
        }
        const float before = centre_slots[index(after - 1)];
        Between(frames, motion, after - 1, (at - before) / (*next - before)).write(video.frame(i));
    });
    return video;
}

FluxVideo interpolate_frames(const FluxVideo& frames, std::span<const float> centre_slots,
                             int slots) {
    std::vector<float> times(index(slots));
    std::iota(times.begin(), times.end(), 0.0F);
    return interpolate_frames(frames, centre_slots, times);
}

MovedFrames move_frames(const FluxVideo& frames) {
    MovedFrames moved{frames, frames};
    const auto motion = motion_of(frames);
    parallel_for(0, frames.slots() - 1, [&](int i) {
        Between(frames, motion, i, 0).write_moved(moved.next.frame(i));
        Between(frames, motion, i, 1).write_moved(moved.previous.frame(i + 1));
    });
    return moved;
}

}  // namespace stipple
